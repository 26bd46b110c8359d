// SPDX-License-Identifier: Apache-2.0
#include "common/decide/sample_cost.h"

#include "common/decide/guiding/guiding_constants.h"
#include "common/decide/next_event/next_event_constants.h"

namespace treefarm {

double sample_cost(const PassPlan& plan, const TraceCounts& counts) {
    const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
    if (counts.paths == 0) return 0;
    const double rays = (plan.guided ? tuned<policy::kGuiding>("guiding.ray_cost") : 1.0) * count(counts.rays) +
                        tuned<policy::kNextEvent>("next_event.shadow_ray_cost") * count(counts.shadow_rays);
    return rays / count(counts.paths);
}

}  // namespace treefarm
