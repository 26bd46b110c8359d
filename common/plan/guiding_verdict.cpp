// SPDX-License-Identifier: Apache-2.0
#include "common/plan/guiding_verdict.h"

#include <algorithm>

#include "common/plan/policy.h"

namespace treefarm {

Guiding judge_guiding(const PassPlan& pass, const GuidingWorth& worth, const GuidingWorth& before, double mistrust) {
    PassPlan judged = pass;
    const bool still_learns = !(before.worth > 0) || worth.worth > before.worth;
    if (!still_learns && pass.spp >= kPolicy.guiding.least_judged_spp)
        judged.spp = std::max(pass.spp, kPolicy.guiding.least_settled_spp);
    return judge_guiding(judged, worth, mistrust);
}

}  // namespace treefarm
