// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "worker/integrators/path/path_recorder.h"
#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/path_state.h"
#include "worker/integrators/path/pending_light.h"

namespace treefarm {

/// Recorder of the directions that the paths of a step have taken.
template <class G>
class DirectionRecords {
  public:
    DirectionRecords(const typename G::Sampler& guide, const PathSettings& settings)
        : guide_(guide), jitters_(settings.jitter_records), bootstraps_(settings.bootstrap > 0.0f) {}

    /// Draws the random numbers of a step; PathState::lane is a path's index in them.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::uint32_t lanes) {
        draw_batch(seed, keys, lanes, 0, Stream::record, draws_);
    }

    /// Adds the vertices of the paths with indices `alive`, each to its own recorder.
    template <class Surface>
    void add(std::span<const PathState<G, Surface>> paths, std::span<const std::uint8_t> alive,
             std::span<PathRecorder<G>> recorders) {
        if (jitters_) find_regions(paths, alive);
        std::uint32_t smooth = 0;
        for (const std::uint8_t index : alive) {
            const PathState<G, Surface>& path = paths[index];
            const auto& s = path.scatter;
            const std::uint32_t rounding = draws_.word[3][path.lane];
            typename G::Target target = G::target(path.guidance);
            if (s.delta) {
                if (!path.surface->smooth()) target = {};
                recorders[index].add_delta_vertex(path.weight, target, rounding);
                continue;
            }
            if (jitters_) target = G::moved(guide_, regions_[smooth++], path.outgoing, target);
            recorders[index].add_vertex(
                target, G::direction(s), s.effective_pdf, path.weight, G::bins(path.guidance, s), rounding,
                bootstraps_ ? G::radiance(guide_, path.guidance, s) : PathRecorder<G>::kUnknown);
        }
    }

  private:
    /// Finds the regions of the records by the stochastic spatial filter; delta lobes have none.
    template <class Surface>
    void find_regions(std::span<const PathState<G, Surface>> paths, std::span<const std::uint8_t> alive) {
        VectorBatch points;
        std::uint32_t count = 0;
        for (const std::uint8_t index : alive) {
            const PathState<G, Surface>& path = paths[index];
            if (path.scatter.delta) continue;
            points.set(count++, guide_.jittered(path.hit.p, path.guidance.region, draws_[path.lane]));
        }
        guide_.regions(points, count, regions_);
    }

    const typename G::Sampler& guide_;
    const bool jitters_, bootstraps_;
    DrawBatch draws_;
    std::array<std::uint32_t, kDrawBatch> regions_;
};

/// Records next event's result at a vertex: the contribution `reflected`, with the MIS weight `weight`.
template <class G, class Surface>
void record_light(const PendingLight<G>& light, const Rgb& reflected, float weight,
                  const typename G::Direction& direction, const PathState<G, Surface>& path,
                  const typename G::Sampler& guide, const PathSettings& settings, PathRecorder<G>& recorder) {
    recorder.add_reflected(light.from.vertex, reflected);
    if (light.from.learned_choice) recorder.add_choice(light.record(guide, average(reflected)));
    // Scattering never hits a light without extent: its samples have weight 1 and teach the guide nothing.
    if (!settings.record_light_samples || light.delta) return;
    typename G::Target target = G::target(light.from.guidance);
    const Draw random = draw(path.key, path.vertex, Stream::light_record);
    if (settings.jitter_records) {
        const std::uint32_t region = guide.region(guide.jittered(path.hit.p, light.from.guidance.region, random));
        target = G::moved(guide, region, path.outgoing, target);
    }
    recorder.add_light_sample(target, direction, light.radiance * weight, average(reflected), light.pdf, random[3]);
}

}  // namespace treefarm
