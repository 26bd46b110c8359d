// SPDX-License-Identifier: Apache-2.0
#include "common/decide/guiding/guiding_verdict.h"

#include <algorithm>
#include <cmath>

#include "common/decide/guiding/guiding_constants.h"

namespace treefarm {

namespace {

/// Efficiency below which guiding is given up: lower after short passes, whose trees still improve much.
double bar(std::uint32_t spp) {
    const double settled =
        std::log2(static_cast<double>(spp) / tuned<policy::kGuiding, std::uint32_t>("guiding.least_settled_spp")) /
        std::log2(static_cast<double>(tuned<policy::kGuiding, std::uint32_t>("guiding.settled_spp")) /
                  tuned<policy::kGuiding, std::uint32_t>("guiding.least_settled_spp"));
    return std::lerp(tuned<policy::kGuiding>("guiding.giving_up_early"), tuned<policy::kGuiding>("guiding.giving_up"),
                     std::clamp(settled, 0.0, 1.0));
}

}  // namespace

Guiding judge_guiding(const PassPlan& pass, const GuidingEfficiency& efficiency, const GuidingEfficiency& before,
                      double mistrust) {
    if (!(efficiency.efficiency > 0) || pass.spp < tuned<policy::kGuiding, std::uint32_t>("guiding.least_judged_spp") ||
        efficiency.known < tuned<policy::kGuiding>("guiding.least_known"))
        return Guiding::open;
    const bool comparable = before.efficiency > 0 && before.known >= tuned<policy::kGuiding>("guiding.least_known");
    const double growth = comparable ? efficiency.efficiency / before.efficiency : 1.0;
    const double next = efficiency.efficiency * std::max(growth, 1.0);
    const double most =
        next * mistrust * std::exp(tuned<policy::kGuiding>("guiding.giving_up_errors") * efficiency.error);
    return most < bar(pass.spp) ? Guiding::loses : Guiding::open;
}

}  // namespace treefarm
