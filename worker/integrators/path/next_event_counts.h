// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include "common/base/random.h"
#include "common/decide/next_event/next_event_constants.h"
#include "worker/integrators/path/path_state.h"
#include "worker/integrators/unit_stats.h"

namespace treefarm {

/// Statistics of direct light in a pass, from which the next pass's rate of emitter sampling is decided: per region if
/// paths record, else for the whole image.
template <bool kRecord>
class NextEventCounts {
  public:
    NextEventCounts(UnitStats& stats, std::span<NextEventSums> regions) : stats_(stats), regions_(regions) {}

    /// Whether a path's direct light is counted: true for a few samples of each pixel.
    static bool counts(const PathKey& key) {
        return key.sample % tuned<policy::kNextEvent, std::uint32_t>("next_event.counted_every") == 0;
    }

    /// Counts a vertex that may sample an emitter; `drawn`: whether it does.
    void asked(std::uint32_t region, bool drawn) const {
        add(region, kNextEventAsked);
        if (drawn) add(region, kNextEventDrawn);
    }
    void traced(std::uint32_t region) const { add(region, kNextEventTraced); }

    /// Counts emission that a scattered direction hits, of the contribution `carried` to the pixel. `light_pdf`:
    /// density of all light samples together at the vertex that the direction left.
    template <class Path>
    [[gnu::noinline]] void emission(const Path& path, const Rgb& carried, float light_pdf) const {
        if (!std::isfinite(path.scatter_pdf)) return;
        add_light(path, path.scatter_region, carried, path.scatter_pdf, light_pdf, path.scatter_light_samples, 0);
    }

    /// Counts light of a sampled emitter at the path's vertex; arguments as for emission().
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
        ++stats_.sums<NextEventSums>()[sum];
        if constexpr (kRecord) ++regions_[region][sum];
    }

    NextEventSums& sums(std::uint32_t region) const {
        if constexpr (kRecord) return regions_[region];
        return stats_.sums<NextEventSums>();
    }

    UnitStats& stats_;
    const std::span<NextEventSums> regions_;
};

}  // namespace treefarm
