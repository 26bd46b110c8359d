// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>

#include "worker/integrators/path/next_event_counts.h"
#include "worker/integrators/path/path_recorder.h"
#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/path_state.h"
#include "worker/integrators/subpath/mis.h"

namespace treefarm {

/// Adds emission that paths hit, weighted against next event. `recorder`: that of the path, if paths record.
template <class G, class Surface, bool kRecord, class Observer>
class Emission {
  public:
    using Path = PathState<G, Surface>;

    Emission(const TraceScene& scene, const PathSettings& settings, Observer& observer,
             const NextEventCounts<kRecord>& counts)
        : scene_(scene), settings_(settings), observer_(observer), counts_(counts) {}

    // Rare and out of line: textured and image emitters cost other vertices neither time nor a register.

    [[gnu::noinline]] void from_emitter(Path& path, PathRecorder<G>* recorder) const {
        const Emitters& emitters = scene_.emitters();
        add(path, recorder, emitters.emitted(path.hit, -path.ray.direction),
            [&] { return emitters.pdf_direct(path.scatter_from, path.ray.direction, path.hit); });
    }

    [[gnu::noinline]] void from_infinity(Path& path, PathRecorder<G>* recorder) const {
        assert(scene_.effects().environment);
        const Emitters& emitters = scene_.emitters();
        add(path, recorder, emitters.environment(path.ray.direction),
            [&] { return emitters.pdf_environment(path.scatter_from, path.ray.direction); });
    }

  private:
    /// Adds `emitted`; next event finds it with the density `next_event_pdf()`.
    template <class Pdf>
    void add(Path& path, PathRecorder<G>* recorder, const Rgb& emitted, Pdf next_event_pdf) const {
        if (is_black(emitted) || (path.depth == 1 && settings_.hide_emitters)) return;
        float light_pdf = 0.0f, weight = 1.0f;
        if (settings_.next_event && path.depth > 1) {
            light_pdf = next_event_pdf() * path.scatter_light_samples;
            weight = mis_weight(settings_.mis, path.scatter_pdf, light_pdf);
        }
        const Rgb weighted = emitted * weight;
        if constexpr (kRecord) recorder->add_emission(weighted);
        observer_.emission(emitted, light_pdf, weight, path.throughput * weighted);
        const Rgb carried = path.throughput * weighted;
        path.radiance += carried;
        if (settings_.estimates_unguided) [[unlikely]]
            add_to_unguided(path, emitted, light_pdf);
        if (settings_.count_next_event && path.depth > 1 && counts_.counts(path.key)) [[unlikely]]
            counts_.emission(path, carried, light_pdf);
    }

    [[gnu::noinline]] void add_to_unguided(Path& path, const Rgb& emitted, float light_pdf) const {
        const bool weighed = settings_.next_event && path.depth > 1;
        const float weight = weighed ? mis_weight(settings_.mis, path.scatter_bsdf_pdf, light_pdf) : 1.0f;
        path.unguided.add(luminance(path.throughput * emitted) * weight * path.inverse_level);
    }

    const TraceScene& scene_;
    const PathSettings& settings_;
    Observer& observer_;
    const NextEventCounts<kRecord>& counts_;
};

}  // namespace treefarm
