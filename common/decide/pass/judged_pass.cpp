// SPDX-License-Identifier: Apache-2.0
#include "common/decide/pass/judged_pass.h"

#include "common/base/policy.h"

namespace treefarm {

double JudgedPass::sample_cost() const {
    const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
    if (counts.paths == 0) return 0;
    const double rays = (plan.guided ? tuned("guiding.ray_cost") : 1.0) * count(counts.rays) +
                        tuned("next_event.shadow_ray_cost") * count(counts.shadow_rays);
    return rays / count(counts.paths);
}

}  // namespace treefarm
