// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"

namespace treefarm {

/// MIS weight of a sample drawn with density `own`, where another technique has density `other` (Veach 1997). Computed
/// from a ratio, so that neither huge nor infinite densities overflow: w(inf, x) = 1, w(0, x) = 0.
inline float mis_weight(MisHeuristic heuristic, float own, float other) {
    if (!(own > 0.0f)) return 0.0f;
    if (std::isinf(own)) return 1.0f;
    if (heuristic == MisHeuristic::equal) return other > 0.0f ? (std::isinf(other) ? 0.0f : 0.5f) : 1.0f;
    const float ratio = other / own;
    return heuristic == MisHeuristic::power ? 1.0f / (1.0f + ratio * ratio) : 1.0f / (1.0f + ratio);
}

}  // namespace treefarm
