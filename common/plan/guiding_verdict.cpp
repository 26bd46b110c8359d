// SPDX-License-Identifier: Apache-2.0
#include "common/plan/guiding_verdict.h"

#include <algorithm>
#include <cmath>

#include "common/plan/policy.h"

namespace treefarm {

Guiding judge_guiding(const PassPlan& pass, const GuidingWorth& worth, const GuidingWorth& before, double mistrust) {
    constexpr const auto& kOf = kPolicy.guiding;
    if (!(worth.worth > 0) || pass.spp < kOf.least_judged_spp || worth.known < kOf.least_known) return Guiding::open;
    const bool comparable = before.worth > 0 && before.known >= kOf.least_known;
    const double growth = comparable ? worth.worth / before.worth : 1.0;
    const double bar = pass.spp < kOf.least_settled_spp ? kOf.giving_up_early : kOf.giving_up;
    const double next = worth.worth * std::max(growth, 1.0);
    const double most = next * mistrust * std::exp(kOf.giving_up_errors * worth.error);
    return most < bar ? Guiding::loses : Guiding::open;
}

}  // namespace treefarm
