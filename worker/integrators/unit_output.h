// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/decide/trace_stats.h"
#include "common/film/aov_film.h"
#include "common/film/pixel_estimate.h"
#include "common/film/splat_film.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Result of rendering a work unit. A thread reuses one, and its memory, for all of its units.
struct UnitOutput {
    std::vector<PixelEstimate> pixels;  ///< of a tile, row by row
    RecordLog log;                      ///< records that teach the guide
    TraceStats stats;
    AovPixels aovs;   ///< AOVs of first_hit/
    SplatLog splats;  ///< contributions to pixels anywhere

    /// Clears the output for the next unit; `distributions`: number in the guide, `shape`: that of the pass's splats.
    void begin(std::uint32_t distributions, const SplatShape& shape = {}) {
        pixels.clear();
        log.begin(distributions);
        stats = {};
        aovs.values.clear();
        aovs.direct.clear();
        splats.begin(shape);
    }
};

}  // namespace treefarm
