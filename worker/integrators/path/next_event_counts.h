// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include "common/base/policy.h"
#include "common/base/random.h"
#include "common/film/trace_stats.h"
#include "worker/integrators/path/path_state.h"

namespace treefarm {

/// What a pass counts of direct light, so that the next knows how often to sample emitters: by region where paths
/// record, else for the whole image.
template <bool kRecord>
class NextEventCounts {
  public:
    NextEventCounts(TraceStats& stats, std::span<NextEventSums> regions) : stats_(stats), regions_(regions) {}

    /// Whether a path is among those along which it is counted: a few samples of each pixel.
    static bool counts(const PathKey& key) {
        return key.sample % tuned<std::uint32_t>("next_event.counted_every") == 0;
    }

    /// A vertex at which an emitter may be sampled, and whether it is.
    void asked(std::uint32_t region, bool drawn) const {
        add(region, kNextEventAsked);
        if (drawn) add(region, kNextEventDrawn);
    }
    void traced(std::uint32_t region) const { add(region, kNextEventTraced); }

    /// Emission that a scattered direction has met, and that brings `carried` to the pixel. `light_pdf`: of all light
    /// samples of the vertex that it left.
    template <class Path>
    [[gnu::noinline]] void emission(const Path& path, const Rgb& carried, float light_pdf) const {
        if (!std::isfinite(path.scatter_pdf)) return;
        add_light(path, path.scatter_region, carried, path.scatter_pdf, light_pdf, path.scatter_light_samples, 0);
    }

    /// Light of a sampled emitter, likewise, at the vertex where the path is.
    template <class Path>
    [[gnu::noinline]] void light(const Path& path, std::uint32_t region, const Rgb& carried, float scatter_pdf,
                                 float light_pdf, float light_samples) const {
        add_light(path, region, carried, scatter_pdf, light_pdf, light_samples, 1);
    }

  private:
    template <class Path>
    void add_light(const Path& path, std::uint32_t region, const Rgb& carried, float scatter_pdf, float light_pdf,
                   float light_samples, std::uint32_t salt) const {
        const std::uint32_t bits =
            scrambled(scrambled(path.key.pixel, path.key.sample + 1), 2 * path.vertex + salt + 1);
        add_direct_light(sums(region), luminance(carried) * path.inverse_level, scatter_pdf, light_pdf / light_samples,
                         light_samples, bits);
    }

    void add(std::uint32_t region, NextEventSum sum) const {
        ++stats_.next_event[sum];
        if constexpr (kRecord) ++regions_[region][sum];
    }

    NextEventSums& sums(std::uint32_t region) const {
        if constexpr (kRecord) return regions_[region];
        return stats_.next_event;
    }

    TraceStats& stats_;
    const std::span<NextEventSums> regions_;
};

}  // namespace treefarm
