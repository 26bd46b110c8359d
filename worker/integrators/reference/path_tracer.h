// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/subpath/mis.h"
#include "worker/integrators/subpath/roulette.h"
#include "worker/integrators/subpath/surface_light.h"

// The radiance that reaches the camera along a ray is an integral over all paths of light to it (Kajiya 1986, "The
// rendering equation"). A path tracer samples one path, backwards and vertex by vertex, and sums the vertices'
// contributions:
//
//     L = sum over k = 1, 2, ... of T_(k-1) (E_k + D_k)        T_0 = 1,  T_k = T_(k-1) f |cos| / pdf
//
// E_k is the radiance that vertex k emits towards the previous one. D_k, next event, is the light of a sampled emitter
// that vertex k reflects. T_k, the throughput, is the fraction of the light at vertex k that reaches the camera, over
// the density of the path's directions.
//
// E_(k+1) and D_k estimate the same light, one by a direction of the BSDF, one by a point on an emitter. Each is
// weighted by its technique's density against the other's; the two weights of a direction sum to one (multiple
// importance sampling, Veach 1997). Russian roulette ends paths at random, and scales up those that continue. No step
// changes the expectation: the mean of many samples is the image.

namespace treefarm {

/// Settings of paths, from job and pass.
struct PathRules {
    int max_depth;     ///< edges of a path; -1: no limit
    bool next_event;   ///< emitters are sampled
    bool delta_alone;  ///< only those without extent are sampled, which nothing else finds
    MisHeuristic mis;
    bool strict_normals;
    bool hide_emitters;  ///< from the camera
    Roulette roulette;

    PathRules(const TraceScene& scene, const Resolved::Integrator& job, const PassPlan& pass)
        : max_depth(job.max_depth),
          next_event(pass.next_event && scene.emitters().can_sample()),
          delta_alone(!pass.next_event && scene.emitters().has_delta_lights()),
          mis(job.mis),
          strict_normals(job.strict_normals),
          hide_emitters(job.hide_emitters),
          roulette(Roulette::Rule::unguided, job.rr_depth) {}
};

/// Tracer of paths over one kind of surface: DiffuseSurface or GeneralSurface.
template <class Surface>
class PathTracer {
  public:
    PathTracer(const TraceScene& scene, const PathRules& rules, TraceStats& stats)
        : scene_(scene), rules_(rules), stats_(stats), scratch_(Surface::make_scratch(scene)) {}

    /// Radiance along a camera ray: each vertex has random numbers of its own, numbered from 1.
    Rgb radiance(const Numbers auto& numbers, const Ray& camera_ray) {
        Path path{camera_ray};
        Rgb sum(0.0f);
        for (int depth = 1;; ++depth) {
            const auto vertex = static_cast<std::uint32_t>(depth);
            Hit hit;
            const bool found = scene_.geometry().intersect(path.ray, hit);
            ++stats_.rays;
            add(sum, path.throughput, emission(path, found ? &hit : nullptr, depth));

            if (!found || depth == rules_.max_depth) return sum;
            // Russian roulette of the last scattering. The scaling by refraction does not count.
            if (depth > 1 && !rules_.roulette.spares(path.throughput, path.spread, depth - 1,
                                                     to_unit(draw(numbers, vertex - 1, Stream::roulette)[0])))
                return sum;

            scene_.geometry().keep_inside(hit, path.ray);
            const Surface surface(scene_, hit, -path.ray.direction, scratch_);
            if (surface.black()) return sum;
            if (rules_.strict_normals && -dot(surface.ng(), path.ray.direction) * surface.wo().z < 0.0f) return sum;
            ++stats_.vertices;

            if (surface.smooth())
                add(sum, path.throughput, next_event(hit, surface, draw(numbers, vertex, Stream::light)));
            if (!scatter(path, hit, surface, draw(numbers, vertex, Stream::scatter))) return sum;
        }
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    /// State of a path: its ray and throughput.
    struct Path {
        Ray ray;
        Rgb throughput{1.0f};
        LightReceiver from = {};   ///< the vertex that the ray left
        float scatter_pdf = 0.0f;  ///< of the ray's direction there; infinite: no other technique finds it
        float spread = 1.0f;       ///< product of eta^2: refraction scales the radiance down, and up again on leaving
    };

    /// Adds T light to the sum; adds nothing if the light is black, however large T is.
    static void add(Rgb& sum, const Rgb& throughput, const Rgb& light) {
        if (!is_black(light)) sum += throughput * light;
    }

    /// E_k: emission that the path's ray hits, weighted against next event at the vertex that it left.
    Rgb emission(const Path& path, const Hit* arrival, int depth) const {
        const Rgb light = emitted(scene_.emitters(), path.ray, arrival);
        if (depth == 1) return rules_.hide_emitters ? Rgb(0.0f) : light;
        if (is_black(light) || !rules_.next_event) return light;
        const float light_pdf = emitter_pdf(scene_.emitters(), path.from, path.ray, arrival);
        return light * mis_weight(rules_.mis, path.scatter_pdf, light_pdf);
    }

    /// D_k: light of a sampled emitter that the surface scatters, weighted against a direction of the BSDF.
    Rgb next_event(const Hit& hit, const Surface& surface, const Draw& random) const {
        if (!rules_.next_event && !rules_.delta_alone) return Rgb(0.0f);
        const Emitters& emitters = scene_.emitters();
        const DirectSample sample = rules_.delta_alone ? emitters.sample_delta(hit.p, random)
                                                       : emitters.sample_direct(receiver_at(hit, surface), random);
        const LightAtSurface light = light_at_surface(scene_, hit, surface, sample, rules_.strict_normals, stats_);
        if (!(light.pdf > 0.0f)) return Rgb(0.0f);
        return light.reflected * (mis_weight(rules_.mis, light.pdf, light.bsdf_pdf) / light.pdf);
    }

    /// Step from T_(k-1) to T_k: continues the path in a direction drawn from the BSDF. False if there is none.
    bool scatter(Path& path, const Hit& hit, const Surface& surface, const Draw& random) const {
        const BsdfSample sample = sample_bsdf(surface, random);
        if (!(sample.pdf > 0.0f) || is_black(sample.f_cos)) return false;
        const Vec3 direction = surface.frame().to_world(sample.wi);
        if (rules_.strict_normals && !normals_agree(surface, direction, sample.wi.z)) return false;
        path.throughput *= sample.f_cos * (1.0f / sample.pdf);
        path.scatter_pdf = sample.delta ? kInfinity : sample.pdf;
        if constexpr (Surface::kTransmits)
            if (sample.wi.z < 0.0f) path.spread *= surface.eta2();
        path.from = receiver_at(hit, surface);
        path.ray = {offset_origin(hit, direction), direction};
        return true;
    }

    const TraceScene& scene_;
    const PathRules rules_;
    TraceStats& stats_;
    typename Surface::Scratch scratch_;
};

}  // namespace treefarm
