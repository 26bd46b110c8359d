// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/lint/estimator_advice.h"

#include <cmath>

#include "coordinator/input/lint/light_reach.h"

namespace treefarm {
namespace {

// Thresholds above which next event hardly finds the lamps, chosen such that the project's scenes get the estimator
// that was better, except for water (bench/log/bidirectional.md, "when should light subpaths be given up").
constexpr double kMostlyHidden = 0.5, kOftenBehindGlass = 0.25, kMostlyFromInfinity = 0.5;

std::string percent(double share) {
    return std::to_string(std::lround(100 * share)) + " %";
}

}  // namespace

EstimatorAdvice estimator_advice(const Scene& scene, const Resolved& job) {
    if (job.scene_facts.lights_alone_find)
        return {
            "bidirectional",
            "emitters without extent shine on mirrors, smooth glass or coats, and only paths from emitters find what "
            "these throw onto other surfaces"};
    const LightReach reach = light_reach(scene);
    if (!reach.known) return {"path", "nothing is known that speaks for another"};
    if (reach.infinity > kMostlyFromInfinity)
        return {"path",
                percent(reach.infinity) +
                    " of the light comes from infinity, where paths from emitters would mostly miss what is seen"};
    if (reach.glass > kOftenBehindGlass)
        return {"bidirectional", "smooth glass lies before " + percent(reach.glass) +
                                     " of the lamps' light, which next event cannot see through"};
    if (reach.blocked > kMostlyHidden)
        return {"bidirectional", "surfaces lie before " + percent(reach.blocked) +
                                     " of the lamps' light, which arrives by way of others"};
    return {"path", "next event sees " + percent(reach.free) + " of the lamps' light"};
}

}  // namespace treefarm
