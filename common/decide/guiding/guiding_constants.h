// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/policy.h"

namespace treefarm::policy {

inline constexpr const char* kAuto = "bench/log/decisions.md#when-is-guiding-given-up";
inline constexpr const char* kHeld = "bench/log/decisions.md#does-auto-hold-in-scenes-that-nobody-tuned-it-on";

/// Whether paths are guided ("auto"), judged by what guided samples estimate for unguided ones.
inline constexpr Constant kGuiding[] = {
    {"guiding.least_judged_spp", 4, "shorter passes are not judged, spp", kAuto},
    {"guiding.ray_cost", 1.4,
     "cost of a guided ray over that of an unguided one, training included; 1.24 to 1.53 by scene", kAuto,
     "0.98, 1.19 (2026-11-28)"},
    {"guiding.mistrusted", 2.0,
     "unguided passes that are so many times as noisy as guided samples have said are believed instead", kDecisions,
     "1.00, 1.00 (2026-11-28)"},
    {"guiding.giving_up", 0.85,
     "paths are unguided where variance times cost of unguided samples over that of guided ones is below this", kHeld,
     "0.96, 0.98 (2026-11-28)"},
    {"guiding.giving_up_early", 0.75,
     "the same after passes of at most least_settled_spp; between those and settled_spp by the logarithm", kJoint},
    {"guiding.giving_up_errors", 1.3, "by so many standard errors", kDecisions, "1.00, 0.96 (2026-11-28)"},
    {"guiding.taking_up", 1.1, "and guided again where it is above this", kDecisions, "1.00, 1.00 (2026-11-28)"},
    {"guiding.least_settled_spp", 16, "trees of shorter passes still get much better, spp", kDecisions},
    {"guiding.settled_spp", 64, "from passes of so many spp on giving_up holds", kHeld},
    {"guiding.least_known", 4.0, "noise that rests on fewer groups of pixels, of 64, is not judged", kDecisions},
};

}  // namespace treefarm::policy
