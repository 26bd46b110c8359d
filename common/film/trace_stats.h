// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/film/guiding_efficiency.h"
#include "common/film/tail_samples.h"
#include "common/math/next_event_sums.h"

namespace treefarm {

/// A sample that the film's door refused: NaN, infinite or negative radiance. It counts as black.
struct InvalidSample {
    std::uint32_t pass = 0;
    std::uint16_t x = 0, y = 0;
    std::uint32_t sample = 0;  ///< within the pass
    float rgb[3] = {0, 0, 0};
};

/// Parts of tracing, timed where farm.profile asks for it.
enum class TracePhase : std::uint8_t {
    intersect,  ///< nearest hits
    surface,    ///< random numbers, points, materials, emitters met and sampled
    direction,  ///< the next direction: regions, samples and densities of BSDF and tree
    shadow,     ///< shadow rays and what they let through
    record,     ///< what is noted for the tree, and the film
};
inline constexpr std::size_t kTracePhases = 5;

/// Sums over pixels of a pass whose paths may be split, with and without their split paths (splitting_gain.h); whole
/// units.
struct SplittingSums {
    std::uint64_t split_mean = 0, unsplit_mean = 0;
    std::uint64_t split_variance = 0, unsplit_variance = 0;  ///< of one sample

    void add(const SplittingSums& other);
};

/// Sums over pixels of a pass whose samples also know what they would bring without their light subpaths
/// (light_subpath_gain.h); whole units.
struct LightSubpathSums {
    std::uint64_t samples = 0;  ///< of which the next four are sums
    std::uint64_t both_mean = 0, alone_mean = 0;
    std::uint64_t both_variance = 0, alone_variance = 0;  ///< of one sample
    std::uint64_t alone_rays = 0;                         ///< that those alone would have traced, shadow rays included

    void add(const LightSubpathSums& other);
    bool operator==(const LightSubpathSums&) const = default;
};

/// What light paths bring, by the entry that each starts from in the table that their emitters are chosen by
/// (emission_shares.h); empty where nobody asks.
struct EmissionSums {
    std::vector<std::uint64_t> paths;
    /// Squares of what each path contributes, as if emitters were chosen by power; saturates at kMostSplatSum.
    std::vector<std::uint64_t> squares;

    void add(const EmissionSums& other);
};

/// Figures of tracing some units: counts are exact sums, seconds are measured (and never enter a result).
struct TraceStats {
    std::uint64_t paths = 0;
    std::uint64_t nonzero_paths = 0;  ///< that carried any radiance
    std::uint64_t rays = 0;           ///< closest-hit rays
    std::uint64_t shadow_rays = 0;
    std::uint64_t vertices = 0;         ///< surface vertices at which a direction was sampled
    std::uint64_t records = 0;          ///< of them, recorded for the tree
    std::uint64_t split_path_rays = 0;  ///< of them, of split paths that paths left where they were split
    std::uint64_t invalid_samples = 0;
    NextEventSums next_event{};  ///< where it is decided; moments where nothing is recorded by region
    SplittingSums splitting;
    UnguidedSums unguided;  ///< where a guided pass asks whether it pays
    LightSubpathSums light_subpaths;
    EmissionSums emission;
    std::vector<InvalidSample> first_invalid;          ///< at most kMaxReported of them, to reproduce
    TailSamples tails;                                 ///< of the path integrator: at most one of a unit
    double trace_seconds = 0;                          ///< thread-seconds in the tile renderer
    double splat_seconds = 0;                          ///< thread-seconds adding records to the tree's sums
    std::array<double, kTracePhases> phase_seconds{};  ///< of trace_seconds; zeros where not timed

    static constexpr std::size_t kMaxReported = 16;
    void add(const TraceStats& other);
};

}  // namespace treefarm
