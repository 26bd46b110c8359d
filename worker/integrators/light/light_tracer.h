// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/plan/resolve/resolve.h"
#include "worker/integrators/subpath/emission_record.h"
#include "worker/integrators/subpath/light_scatter.h"
#include "worker/integrators/subpath/roulette.h"
#include "worker/integrators/subpath/sensor.h"
#include "worker/integrators/unit_output.h"

// The image is an integral over all paths from a lamp to the camera, and these may be sampled from either end. A light
// path starts at an emitter, with the power emitted there over the density of start and direction, and scatters on.
// Each vertex is connected to a point of the lens: its light towards the lens,
//
//     alpha F(in -> lens) g        alpha: power over the path's density,  F: scattering,  g: camera importance
//
// is splatted to the pixel that sees the vertex, unless it is occluded. Each path may thus contribute to any pixel, and
// the mean over n paths per pixel is the image. The start on a visible lamp is connected as well.

namespace treefarm {

/// Settings of light paths, from the job.
struct LightPathRules {
    int max_depth;  ///< edges of a path from lamp to lens; -1: no limit
    bool strict_normals, hide_emitters;
    Roulette roulette;

    explicit LightPathRules(const Resolved::Integrator& job)
        : max_depth(job.max_depth),
          strict_normals(job.strict_normals),
          hide_emitters(job.hide_emitters),
          roulette(Roulette::Rule::unguided, job.rr_depth) {}
};

/// Connections to the lens. Their shadow rays are collected, since many together are faster.
template <Numbers N>
class LightConnections {
  public:
    LightConnections(const EmbreeScene& geometry, EmissionRecord& record, UnitOutput& output)
        : geometry_(geometry), record_(record), output_(output) {}

    /// Adds a connection; `emitter`: the one that its path started from.
    void add(const Ray& ray, std::uint32_t pixel, const Rgb& value, const N& numbers, std::uint32_t vertex,
             std::uint32_t emitter) {
        rays_[count_] = ray;
        splats_[count_++] = {value, numbers, pixel, vertex, emitter};
        if (count_ == rays_.size()) flush();
    }

    /// Traces the shadow rays, and splats the connections that reach the camera.
    void flush() {
        geometry_.occluded({rays_.data(), count_}, hidden_.data());
        output_.stats.shadow_rays += count_;
        for (std::size_t i = 0; i < count_; ++i) {
            if (hidden_[i]) continue;
            const auto& [value, numbers, pixel, vertex, emitter] = splats_[i];
            const double light = luminance(value);
            record_.add(emitter, light * light);
            output_.splats.add(pixel, numbers.sample, value, draw(numbers, vertex, Stream::splat_round));
            const bool same_path = lit_any_ && numbers.pixel == last_lit_.pixel && numbers.sample == last_lit_.sample;
            if (!same_path) ++output_.stats.nonzero_paths;
            lit_any_ = true;
            last_lit_ = {.pixel = numbers.pixel, .sample = numbers.sample};
        }
        count_ = 0;
    }

  private:
    struct Splat {
        Rgb value;
        N numbers;
        std::uint32_t pixel, vertex, emitter;
    };

    const EmbreeScene& geometry_;
    EmissionRecord& record_;
    UnitOutput& output_;
    std::array<Ray, EmbreeScene::kMostTogether> rays_;
    std::array<Splat, EmbreeScene::kMostTogether> splats_;
    std::array<bool, EmbreeScene::kMostTogether> hidden_{};
    std::size_t count_ = 0;
    PathKey last_lit_;  ///< last path that splatted: the splats of a path are consecutive
    bool lit_any_ = false;
};

/// Tracer of light paths over one kind of surface: DiffuseSurface or GeneralSurface. The compiler inlines functions
/// with one caller only where no other file can call them; hence the attributes.
template <class Surface, Numbers N = PathKey>
class LightTracer {
  public:
    LightTracer(const TraceScene& scene, const Sensor& sensor, const LightPathRules& rules,
                const EmissionChoice& choice, EmissionRecord& record, UnitOutput& output)
        : scene_(scene),
          sensor_(sensor),
          rules_(rules),
          choice_(choice),
          record_(record),
          stats_(output.stats),
          connections_(scene.geometry(), record, output),
          arriving_(Surface::make_scratch(scene)),
          leaving_(Surface::make_scratch(scene)) {}

    /// Traces a light path: each vertex has its own random numbers, the emitter 0, surfaces from 1 on.
    [[gnu::always_inline]] void trace(const N& numbers) {
        ++stats_.paths;
        const EmissionSample start = scene_.emitters().emit(draw(numbers, 0, Stream::light_start),
                                                            draw(numbers, 0, Stream::light_scatter), &choice_);
        if (start.from != EmissionFrom::nothing) record_.start(start.entry);
        const Draw lens = draw(numbers, 0, Stream::lens_connect);
        if (start.from == EmissionFrom::surface && !rules_.hide_emitters) connect_lamp(start, numbers, lens);
        if (!is_black(start.weight) && rules_.max_depth != 1) walk(start, numbers, lens);
    }

    void finish() { connections_.flush(); }

  private:
    /// Number of a path's vertex, and the emitter that the path started from.
    struct SplatSource {
        N numbers;
        std::uint32_t vertex, emitter;
    };

    [[gnu::always_inline]] void walk(const EmissionSample& start, const N& numbers, const Draw& lens) {
        Ray ray = start.ray;
        Rgb throughput(1.0f);  // since the emitter
        for (int depth = 1;; ++depth) {
            const auto vertex = static_cast<std::uint32_t>(depth);
            Hit hit;
            ++stats_.rays;
            if (!scene_.geometry().intersect(ray, hit)) return;
            if (depth > 1 && !rules_.roulette.spares(throughput, 1.0f, depth - 1,
                                                     to_unit(draw(numbers, vertex - 1, Stream::light_roulette)[0])))
                return;
            scene_.geometry().keep_inside(hit, ray);
            const Vec3 in = -ray.direction;
            connect(hit, in, start.weight * throughput, {numbers, vertex, start.entry}, lens);
            if (depth + 1 == rules_.max_depth) return;
            const Surface surface(scene_, hit, in, arriving_);
            if (surface.black()) return;
            ++stats_.vertices;
            const LightStep step = scatter_light(scene_, hit, surface, in, rules_.strict_normals,
                                                 draw(numbers, vertex, Stream::light_scatter), leaving_);
            if (!step.goes_on) return;
            throughput *= step.weight;
            ray = {offset_origin(hit, step.direction), step.direction};
        }
    }

    /// Connects the start point on the emitter to the lens.
    void connect_lamp(const EmissionSample& start, const N& numbers, const Draw& lens) {
        const FilmConnection to = sensor_.importance.connect(start.start.p, lens);
        const float cosine = dot(start.start.ng, to.direction);
        if (!to.seen || !(cosine > 0.0f)) return;
        add(start.start, to, start.radiance, double(cosine) / double(start.position_pdf), {numbers, 0, start.entry});
    }

    /// Connects a vertex to the lens; `light` arrives there from `in`.
    void connect(const Hit& hit, const Vec3& in, const Rgb& light, const SplatSource& source, const Draw& lens) {
        if (scene_.geometry().hidden(hit.shape)) return;
        const FilmConnection to = sensor_.importance.connect(hit.p, lens);
        if (!to.seen || !sensor_.pixels.reaches(to.x, to.y)) return;
        const LightScattering scattering =
            light_scattering<Surface>(scene_, hit, in, to.direction, rules_.strict_normals, leaving_);
        add(hit, to, light * scattering.f, 1.0, source);
    }

    /// Adds a vertex's contribution, `factor` times the colour.
    [[gnu::always_inline]] void add(const Hit& hit, const FilmConnection& to, const Rgb& colour, double factor,
                                    const SplatSource& source) {
        if (is_black(colour)) return;
        const auto& [numbers, vertex, emitter] = source;
        const PixelPick pick = sensor_.pixels.pick(to.x, to.y, draw(numbers, vertex, Stream::filter_pick));
        if (!pick.found) return;
        connections_.add(ray_to_lens(hit, to), pick.pixel, colour * static_cast<float>(factor * to.g * pick.weight),
                         numbers, vertex, emitter);
    }

    const TraceScene& scene_;
    const Sensor& sensor_;
    const LightPathRules rules_;
    const EmissionChoice& choice_;
    EmissionRecord& record_;
    TraceStats& stats_;
    LightConnections<N> connections_;
    typename Surface::Scratch arriving_, leaving_;  ///< of surfaces as light sees them, and as the camera sees them
};

}  // namespace treefarm
