// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/decide/next_event/next_event_constants.h"
#include "worker/integrators/path/next_event_counts.h"
#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/seen_light.h"
#include "worker/lights/light_lanes.h"

namespace treefarm {

/// Stochastic choice of the vertices at which next event samples an emitter, with the counts from which the sampling
/// rate is decided. Lights without extent are always sampled: if there are any, the emitter is chosen before the random
/// decision.
template <class G, bool kConverts, bool kRecord>
class LightChances {
  public:
    LightChances(const typename G::Sampler& guide, const PathSettings& settings, const NextEventCounts<kRecord>& counts)
        : guide_(guide), settings_(settings), counts_(counts) {}

    /// Sets the average number of light samples of a vertex and, by the second word of the path's numbers, whether one
    /// is drawn.
    template <class Path>
    void decide(Path& path, const DrawBatch& draws) const {
        path.light_samples = 1.0f;
        path.samples_emitters = true;
        if (settings_.thin_next_event) [[unlikely]] {
            path.light_samples = light_samples(path);
            path.samples_emitters = to_unit(draws.word[1][path.lane]) < path.light_samples;
        }
        if (counts(path) && !settings_.delta_lights) [[unlikely]]
            count(path);
    }

    /// Whether the vertex needs an emitter to be chosen.
    template <class Path>
    bool needs_emitter(const Path& path) const {
        return path.samples_emitters || settings_.delta_lights;
    }

    /// Whether the chosen emitter is sampled; `delta`: it has no extent.
    template <class Path>
    bool accepts(const Path& path, bool delta) const {
        if (!settings_.delta_lights || delta || !settings_.next_event) [[likely]]
            return true;
        if (counts(path)) count(path);
        return path.samples_emitters;
    }

    /// Counts a shadow ray.
    template <class Path>
    void traced(Path& path, bool delta) const {
        if constexpr (kConverts)
            if (settings_.estimates_unguided)
                path.unguided.add_cost(static_cast<float>(tuned<policy::kNextEvent>("next_event.shadow_ray_cost")));
        if (counts(path) && !delta) [[unlikely]]
            counts_.traced(path.guidance.region);
    }

    /// Adds a sample's contribution to the pixel to the counts.
    template <class Path>
    void add(const Path& path, const PendingLight<G>& light, const SeenLight& seen, const Rgb& carried) const {
        if (counts(path) && !light.delta) [[unlikely]]
            counts_.light(path, light.from.guidance.region, carried, seen.scatter_pdf, seen.light_pdf,
                          light.from.light_samples);
    }

  private:
    template <class Path>
    bool counts(const Path& path) const {
        return settings_.count_next_event && counts_.counts(path.key);
    }
    template <class Path>
    float light_samples(const Path& path) const {
        if (settings_.light_samples > 0.0f) return settings_.light_samples;
        if constexpr (kConverts) return guide_.next_event(path.guidance.region);
        return guide_.image_next_event();
    }
    template <class Path>
    [[gnu::noinline]] void count(const Path& path) const {
        counts_.asked(path.guidance.region, path.samples_emitters);
    }

    const typename G::Sampler& guide_;
    const PathSettings& settings_;
    const NextEventCounts<kRecord>& counts_;
};

}  // namespace treefarm
