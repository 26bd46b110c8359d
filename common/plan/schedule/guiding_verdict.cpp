// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/guiding_verdict.h"

#include <algorithm>
#include <cmath>

#include "common/base/policy.h"

namespace treefarm {

namespace {

/// The worth below which guiding is given up: lower after short passes, whose trees still get much better.
double bar(std::uint32_t spp) {
    constexpr const auto& kOf = kPolicy.guiding;
    const double settled = std::log2(static_cast<double>(spp) / kOf.least_settled_spp) /
                           std::log2(static_cast<double>(kOf.settled_spp) / kOf.least_settled_spp);
    return std::lerp(kOf.giving_up_early, kOf.giving_up, std::clamp(settled, 0.0, 1.0));
}

}  // namespace

Guiding judge_guiding(const PassPlan& pass, const GuidingWorth& worth, const GuidingWorth& before, double mistrust) {
    constexpr const auto& kOf = kPolicy.guiding;
    if (!(worth.worth > 0) || pass.spp < kOf.least_judged_spp || worth.known < kOf.least_known) return Guiding::open;
    const bool comparable = before.worth > 0 && before.known >= kOf.least_known;
    const double growth = comparable ? worth.worth / before.worth : 1.0;
    const double next = worth.worth * std::max(growth, 1.0);
    const double most = next * mistrust * std::exp(kOf.giving_up_errors * worth.error);
    return most < bar(pass.spp) ? Guiding::loses : Guiding::open;
}

}  // namespace treefarm
