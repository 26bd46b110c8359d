// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/guiding/regions/mixture.h"
#include "worker/integrators/path/path_recorder.h"
#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/path_state.h"
#include "worker/integrators/path/pending_light.h"

namespace treefarm {

/// Notes the directions that the paths of a step have taken.
template <bool kViews>
class DirectionRecords {
  public:
    DirectionRecords(const SdTreeSampler& guide, const PathSettings& settings)
        : guide_(guide), jitters_(settings.jitter_records) {}

    /// The random numbers of a step; PathState::lane says which are a path's.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::uint32_t lanes) {
        draw_batch(seed, keys, lanes, 0, Stream::record, draws_);
    }

    /// Adds the vertices of the paths whose numbers are in `alive`, each to the path's own recorder.
    template <class Surface>
    void add(std::span<const PathState<Surface>> paths, std::span<const std::uint8_t> alive,
             std::span<PathRecorder> recorders) {
        if (jitters_) find_regions(paths, alive);
        std::uint32_t smooth = 0;
        for (const std::uint8_t index : alive) {
            const PathState<Surface>& path = paths[index];
            const ScatterSample& s = path.scatter;
            const std::uint32_t rounding = draws_.word[3][path.lane];
            RecordTarget target{path.guidance.region, path.guidance.view};
            if (s.delta) {
                if (!path.surface->smooth()) target = {};
                recorders[index].add_delta_vertex(path.weight, target, rounding);
                continue;
            }
            if (jitters_) target = moved<kViews>(guide_, regions_[smooth++], path.outgoing_code, target);
            MixtureBins bins{mixture_bin(s.bsdf_pdf, s.guide_pdf)};
            if (kViews && path.guidance.has_view())
                bins.view = mixture_bin(without_view(path.guidance, s.bsdf_pdf, s.guide_pdf), s.view_pdf);
            recorders[index].add_vertex(target, s.code, s.effective_pdf, path.weight, bins, rounding);
        }
    }

  private:
    /// Finds where the stochastic spatial filter puts the records, delta lobes' left out.
    template <class Surface>
    void find_regions(std::span<const PathState<Surface>> paths, std::span<const std::uint8_t> alive) {
        VectorBatch points;
        std::uint32_t count = 0;
        for (const std::uint8_t index : alive) {
            const PathState<Surface>& path = paths[index];
            if (path.scatter.delta) continue;
            points.set(count++, guide_.jittered(path.hit.p, path.guidance.region, draws_[path.lane]));
        }
        guide_.regions(points, count, regions_);
    }

    const SdTreeSampler& guide_;
    const bool jitters_;
    DrawBatch draws_;
    std::array<std::uint32_t, kDrawBatch> regions_;
};

/// Notes what next event found at a vertex: `reflected` of it, at `weight` against scattering.
template <bool kViews, class Surface>
void record_light(const PendingLight& light, const Rgb& reflected, float weight, std::uint32_t code,
                  const PathState<Surface>& path, const SdTreeSampler& guide, const PathSettings& settings,
                  PathRecorder& recorder) {
    recorder.add_reflected(light.from.vertex, reflected);
    if (light.from.learned_choice) recorder.add_choice(light.record(guide, average(reflected)));
    // Scattering never meets a light without extent: its samples are weighted alone and teach the guide nothing.
    if (!settings.record_light_samples || light.delta) return;
    RecordTarget target{light.from.guidance.region, light.from.guidance.view};
    const Draw random = draw(path.key, path.vertex, Stream::light_record);
    if (settings.jitter_records) {
        const std::uint32_t region = guide.region(guide.jittered(path.hit.p, target.region, random));
        target = moved<kViews>(guide, region, path.outgoing_code, target);
    }
    recorder.add_light_sample(target, code, light.radiance * weight, average(reflected), light.pdf, random[3]);
}

}  // namespace treefarm
