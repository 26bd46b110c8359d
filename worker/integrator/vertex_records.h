#pragma once

#include "common/guiding/mixture.h"
#include "worker/integrator/path_recorder.h"
#include "worker/integrator/path_settings.h"
#include "worker/integrator/path_state.h"
#include "worker/integrator/pending_light.h"

namespace treefarm {

/// Notes the direction that a path has taken at a vertex.
template <bool kViews, class Surface>
void record_direction(const PathState<Surface>& path, const Guide& guide, const PathSettings& settings,
                      const DrawBatch& jitter_draws, PathRecorder& recorder) {
    const ScatterSample& s = path.scatter;
    RecordTarget target{path.guidance.region, path.guidance.view};
    if (s.delta) {
        if (!path.surface->smooth()) target = {};
        recorder.add_delta_vertex(path.weight, target, path.vertex);
        return;
    }
    if (settings.jitter_records)
        target = moved<kViews>(guide, path.hit.p, path.outgoing_code, target, jitter_draws[path.lane]);
    MixtureBins bins{mixture_bin(s.bsdf_pdf, s.guide_pdf)};
    if (kViews && path.guidance.has_view())
        bins.view = mixture_bin(without_view(path.guidance, s.bsdf_pdf, s.guide_pdf), s.view_pdf);
    recorder.add_vertex(target, s.code, s.effective_pdf, path.weight, bins, path.vertex);
}

/// Notes what next event found at a vertex: `reflected` of it, at `weight` against scattering.
template <bool kViews, class Surface>
void record_light(const PendingLight& light, const Rgb& reflected, float weight, std::uint32_t code,
                  const PathState<Surface>& path, const Guide& guide, const PathSettings& settings,
                  PathRecorder& recorder) {
    recorder.add_reflected(light.from.vertex, reflected);
    if (light.from.learned_choice) recorder.add_choice(light.record(guide, average(reflected)));
    // Scattering never meets a light without extent: its samples are weighted alone and teach the guide nothing.
    if (!settings.record_light_samples || light.delta) return;
    RecordTarget target{light.from.guidance.region, light.from.guidance.view};
    if (settings.jitter_records)
        target = moved<kViews>(guide, path.hit.p, path.outgoing_code, target,
                               draw(path.key, path.vertex, Stream::light_jitter));
    recorder.add_light_sample(target, code, light.radiance * weight, average(reflected), light.pdf, path.vertex);
}

}  // namespace treefarm
