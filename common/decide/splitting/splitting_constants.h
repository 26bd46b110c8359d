// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/policy.h"

namespace treefarm::policy {

inline constexpr const char* kSplits = "bench/log/splitting-and-roulette.md";

/// Splitting: number of paths that one splits into, and when splitting is given up.
inline constexpr Constant kSplitting[] = {
    {"splitting.usual", 8, "as how many paths one may go on (guiding.splitting = 0)", kSplits,
     "1.00, 0.99 (2026-11-26)"},
    {"splitting.least_share", 1.4,
     "of what the first vertex sends to the camera, what each path of a split is expected to carry at least", kSplits,
     "1.00, 0.98 (2026-11-26)"},
    {"splitting.least_quietened", 1.01, "splitting ends where samples are not at least so many times quieter", kSplits},
    {"splitting.least_found", 0.99, "passes whose unsplit samples find less of the light are not judged", kSplits},
    {"splitting.least_spp", 16, "nor have shorter ones, spp", kSplits},
    {"splitting.least_gain", 0.97, "it may cost a little more than it shows: whole renders gain more", kSplits},
    {"splitting.least_gain_alone", 0.9, "the same without next event, where they gain most", kSplits},
    {"splitting.shown_gain", 2.2,
     "with next event the gain that is seen is so many times what renders gain that never split", kSplits},
    {"splitting.copy_ray_cost", 1.4, "cost of a copy's ray over that of another", kSplits},
};

}  // namespace treefarm::policy
