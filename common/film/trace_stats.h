// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/film/guiding_efficiency.h"
#include "common/film/tail_samples.h"
#include "common/math/next_event_sums.h"

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

/// Sums over pixels of a pass that may split paths, with and without the split paths (splitting_gain.h); whole units.
struct SplittingSums {
    std::uint64_t split_mean = 0, unsplit_mean = 0;
    std::uint64_t split_variance = 0, unsplit_variance = 0;  ///< of one sample

    void add(const SplittingSums& other);
};

/// Sums over pixels of a pass whose samples are also known without their light subpaths (light_subpath_gain.h); whole
/// units.
struct LightSubpathSums {
    std::uint64_t samples = 0;  ///< number of samples behind the next four sums
    std::uint64_t both_mean = 0, alone_mean = 0;
    std::uint64_t both_variance = 0, alone_variance = 0;  ///< of one sample
    std::uint64_t alone_rays = 0;  ///< rays of samples without light subpaths, shadow rays included

    void add(const LightSubpathSums& other);
    bool operator==(const LightSubpathSums&) const = default;
};

/// Contributions of light paths, by the entry of the emission table at which each started (emission_shares.h); empty
/// unless requested.
struct EmissionSums {
    std::vector<std::uint64_t> paths;
    /// Squares of the contribution of each path, as if emitters were chosen by power; saturates at kMostSplatSum.
    std::vector<std::uint64_t> squares;

    void add(const EmissionSums& other);
};

/// Figures of tracing some units: counts are exact sums; seconds are measured and never influence a result.
struct TraceStats {
    std::uint64_t paths = 0;
    std::uint64_t nonzero_paths = 0;  ///< paths with any radiance
    std::uint64_t rays = 0;           ///< closest-hit rays
    std::uint64_t shadow_rays = 0;
    std::uint64_t vertices = 0;         ///< surface vertices at which a direction was sampled
    std::uint64_t records = 0;          ///< vertices recorded for the guide
    std::uint64_t split_path_rays = 0;  ///< rays of split paths, within `rays`
    std::uint64_t invalid_samples = 0;
    NextEventSums next_event{};  ///< filled if a decision on next event needs it; moments only in passes that do not
                                 ///< record by region
    SplittingSums splitting;
    UnguidedSums unguided;  ///< of guided passes that measure guiding efficiency
    LightSubpathSums light_subpaths;
    EmissionSums emission;
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
