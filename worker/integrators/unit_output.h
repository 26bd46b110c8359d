// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/pixel_estimate.h"
#include "common/film/splat_film.h"
#include "common/guiding/any_guide.h"
#include "worker/integrators/unit_stats.h"

namespace treefarm {

/// Result of rendering a work unit. A thread reuses one, and its memory, for all of its units.
struct UnitOutput {
    std::vector<PixelEstimate> pixels;  ///< of a tile, row by row
    AnyLog log;                         ///< records that teach the guide
    UnitStats stats;
    AovPixels aovs;   ///< AOVs of first_hit/
    SplatLog splats;  ///< contributions to pixels anywhere

    /// Clears the output for the next unit of a pass over `guide`; `shape`: that of the pass's splats.
    void begin(const AnySampler& guide, const SplatShape& shape = {}) {
        pixels.clear();
        log.begin(guide.kind(), guide.regions().distribution_count());
        stats = {};
        aovs.values.clear();
        aovs.direct.clear();
        splats.begin(shape);
    }
};

}  // namespace treefarm
