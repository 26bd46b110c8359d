// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/policy.h"

namespace treefarm::policy {

inline constexpr const char* kEnds = "bench/log/bidirectional.md#when-should-light-subpaths-be-given-up";
inline constexpr const char* kMissed = "bench/log/bidirectional.md";

/// Light subpaths of bidirectional samples: when they are given up, and which emitters they start from.
inline constexpr Constant kLightSubpaths[] = {
    {"light_subpaths.ray_cost", 1.7,
     "cost of a ray of a bidirectional sample over that of a path from the camera, connections included", kEnds},
    {"light_subpaths.least_gain", 0.9,
     "light subpaths are given up where samples without them have less than this times their variance at equal cost",
     kEnds},
    {"light_subpaths.least_found", 0.95, "but not where those find less of the light: nobody knows how noisy they are",
     kEnds},
    {"light_subpaths.least_spp", 4, "shorter passes are not judged, spp", kEnds},
    {"light_subpaths.most_of_mean", 32.0,
     "what a sample brings is compared up to so many times the usual: a firefly that both kinds meet hides what else "
     "differs",
     kMissed},
    {"light_subpaths.missed_errors", 1.0,
     "light that samples without them have missed is noise where it is more than so many standard errors", kRare},
};

}  // namespace treefarm::policy
