// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/pixel_estimate.h"
#include "common/film/splat_film.h"
#include "common/film/trace_stats.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// What rendering a work unit gives. A thread keeps one for all of its units: memory is reused.
struct UnitOutput {
    std::vector<PixelEstimate> pixels;  ///< of a tile, row by row
    RecordLog log;                      ///< what the unit teaches the guide
    TraceStats stats;
    AovPixels aovs;   ///< beside what the integrator makes (first_hit/)
    SplatLog splats;  ///< what the unit brings to pixels anywhere

    /// Empties it for the next unit; `distributions`: of the guide, `shape`: of the pass's splats.
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
