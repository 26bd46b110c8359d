// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/film/tail_samples.h"
#include "common/film/trace_counts.h"

namespace treefarm {

/// A sample of NaN, infinite or negative radiance, which the film refused: it counts as black.
struct InvalidSample {
    std::uint32_t pass = 0;
    std::uint16_t x = 0, y = 0;
    std::uint32_t sample = 0;  ///< index within the pass
    float rgb[3] = {0, 0, 0};
};

/// Phases of tracing, timed if farm.profile is set.
enum class TracePhase : std::uint8_t {
    intersect,  ///< nearest hits
    surface,    ///< random numbers, hit points, materials, emitters hit and sampled
    direction,  ///< next direction: regions, samples and densities of BSDF and guide
    shadow,     ///< shadow rays and transmission along them
    record,     ///< recording for the guide, and the film
};
inline constexpr std::size_t kTracePhases = 5;

/// Figures of tracing some units: counts are exact sums; seconds are measured and never influence a result.
struct TraceStats : TraceCounts {
    std::vector<InvalidSample> first_invalid;          ///< the first kMaxReported at most, to reproduce them
    TailSamples tails;                                 ///< of the path integrator: at most one per unit
    double trace_seconds = 0;                          ///< thread-seconds in the tile renderer
    double splat_seconds = 0;                          ///< thread-seconds of adding records to the guide's sums
    std::array<double, kTracePhases> phase_seconds{};  ///< parts of trace_seconds; zeros if not timed
    double busy_seconds = 0;  ///< thread-seconds with a unit, also those in which the thread had no processor

    static constexpr std::size_t kMaxReported = 16;
    void add(const TraceStats& other);
};

}  // namespace treefarm
