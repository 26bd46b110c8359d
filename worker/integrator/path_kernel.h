#pragma once

#include <cassert>

#include "common/config/job.h"
#include "common/film/trace_stats.h"
#include "common/guiding/mixture.h"
#include "common/plan/schedule.h"
#include "worker/integrator/guided_sampling.h"
#include "worker/integrator/mis.h"
#include "worker/integrator/path_recorder.h"
#include "worker/integrator/roulette.h"
#include "worker/integrator/surface.h"

namespace treefarm {

/// What the walk is told besides the scene: fixed for a pass.
struct PathSettings {
    int max_depth;
    bool next_event;   ///< a flag, not a kernel of its own: one predictable branch per vertex
    bool delta_alone;  ///< no next event, but for the lights that nothing else finds
    MisHeuristic mis;
    bool strict_normals;
    bool hide_emitters;
    bool record_light_samples;  ///< kick-start: what next event finds teaches the tree, too
    bool jitter_records;        ///< stochastic spatial filter
    GuidingTarget target;
    Roulette roulette;

    PathSettings(const TraceScene& scene, const Job& job, const PassPlan& pass, const Guide& guide)
        : max_depth(job.integrator.max_depth),
          next_event(pass.next_event && scene.emitters().can_sample()),
          delta_alone(!pass.next_event && scene.emitters().has_delta_lights()),
          mis(job.integrator.mis),
          strict_normals(job.integrator.strict_normals),
          hide_emitters(job.integrator.hide_emitters),
          record_light_samples(job.integrator.next_event == NextEvent::kickstart && pass.next_event),
          jitter_records(job.guiding.spatial_filter == SpatialFilter::stochastic),
          target(job.guiding.target),
          roulette(job.guiding.type == GuidingType::none ? Roulette::Rule::unguided
                   : guide.trained()                     ? Roulette::Rule::trained
                                                         : Roulette::Rule::untrained,
                   job.integrator.rr_depth) {}
};

/// Watches nothing, at no cost. describe_sample() passes one that writes.
struct NoObserver {
    void camera(const Ray&) {}
    void arrive(int, const Hit*) {}
    void emission(const Rgb&, float, float, const Rgb&) {}
    void scatter(const ScatterSample&, const Rgb&) {}
    void next_event(const DirectSample&, float, float, const Rgb&) {}
    void roulette(float, bool) {}
    void end(const char*) {}
};

/// Path tracing from the camera with optional next event, guiding and recording (Mueller et al. 2017; the order of
/// tests is that of their program). Depth counts path edges: a surface seen by the camera has depth 1. One kernel per
/// thread. `Surface` is one of surface.h.
template <class Surface, bool kGuided, bool kRecord, class Observer = NoObserver>
class PathKernel {
  public:
    PathKernel(const TraceScene& scene, const Guide& guide, const PathSettings& settings, TraceStats& stats)
        : scene_(scene),
          guide_(guide),
          settings_(settings),
          stats_(stats),
          scratch_(Surface::make_scratch(scene)),
          recorder_(settings.target) {}

    /// Radiance along a camera ray. What was learned stays in recorder() until it is committed or the next path begins.
    Rgb trace(const PathKey& path, Ray ray) {
        Rgb radiance(0.0f), throughput(1.0f);
        float scatter_pdf = 0.0f;  // infinite after a delta lobe: next event cannot have found what it meets
        float spread = 1.0f;       // product of eta^2: what refraction took from the throughput and gives back later
        Vec3 scatter_point(0.0f);
        if constexpr (kRecord) recorder_.begin_path();
        observer_.camera(ray);
        if (settings_.max_depth == 0) return radiance;
        for (int depth = 1;; ++depth) {
            Hit hit;
            ++stats_.rays;
            const bool found = scene_.geometry().intersect(ray, hit);
            observer_.arrive(depth, found ? &hit : nullptr);

            if (!found) {
                if (scene_.emitters().shines_from_infinity()) [[unlikely]]
                    radiance += from_infinity(ray.direction, depth, scatter_pdf, throughput);
                return end(radiance, "left the scene");
            }
            if (scene_.emitters().emits(hit.shape)) [[unlikely]]
                radiance += from_emitter(hit, ray.direction, scatter_point, depth, scatter_pdf, throughput);
            if (depth == settings_.max_depth) return end(radiance, "depth limit");

            if (depth > 1 && settings_.roulette.plays(depth - 1)) {
                const float survival = settings_.roulette.survival(throughput, Surface::kTransmits ? spread : 1.0f);
                const bool survives = to_unit(draw(path, vertex_of(depth - 1), Stream::roulette)[0]) < survival;
                observer_.roulette(survival, survives);
                if (!survives) return end(radiance, "roulette");
                throughput *= 1.0f / survival;
                if constexpr (kRecord) recorder_.survive(survival);
            }

            const Surface surface(scene_, hit, -ray.direction, scratch_);
            if (surface.black()) return end(radiance, "black surface");
            if (settings_.strict_normals && -dot(surface.ng(), ray.direction) * surface.wo().z < 0.0f)
                return end(radiance, "normals disagree");

            ++stats_.vertices;
            std::uint32_t region = 0;
            if ((kGuided || kRecord) && surface.smooth()) {
                region = guide_.region(hit.p);
                if constexpr (kRecord)
                    if (!guide_.contains(hit.p)) recorder_.add_outside();
            }
            const GuidedSampling<Bsdf, kGuided> sampling(surface.bsdf(), surface.frame(), surface.wo(), guide_, region,
                                                         surface.smooth());

            if ((settings_.next_event || settings_.delta_alone) && surface.smooth()) {
                const Rgb reflected = next_event(path, depth, hit, surface, sampling, region, throughput);
                radiance += throughput * reflected;
                if constexpr (kRecord) recorder_.add_reflected(reflected);
            }

            const ScatterSample s = sampling.sample(draw(path, vertex_of(depth), Stream::scatter), kRecord);
            if (!(s.pdf > 0.0f) || is_black(s.f_cos)) return end(radiance, "no direction");
            if (settings_.strict_normals && dot(surface.ng(), s.world) * s.local.z <= 0.0f)
                return end(radiance, "normals disagree");
            const Rgb weight = s.f_cos * (1.0f / s.pdf);
            throughput *= weight;
            observer_.scatter(s, throughput);
            scatter_pdf = s.pdf;
            scatter_point = hit.p;
            // One question for what is rare: the same bits say that a lobe may be delta, or refract.
            const bool rare = Surface::kGeneral && surface.delta_or_transmitting();
            if constexpr (Surface::kTransmits)
                if (rare && s.local.z < 0.0f) spread *= surface.eta2();
            assert(spread == 1.0f || scene_.effects().transmission);
            if (rare && s.delta) {
                if constexpr (kRecord)
                    recorder_.add_delta_vertex(weight, surface.smooth() ? region : PathRecorder::kNotRecorded,
                                               vertex_of(depth));
                scatter_pdf = std::numeric_limits<float>::infinity();
            } else {
                if constexpr (kRecord)
                    recorder_.add_vertex(record_region(path, depth, hit.p, region, Stream::jitter), s.code, s.pdf,
                                         weight, mixture_bin(s.bsdf_pdf, s.guide_pdf), vertex_of(depth));
            }
            ray = {offset_origin(hit, s.world), s.world};
        }
    }

    PathRecorder& recorder() { return recorder_; }
    Observer& observer() { return observer_; }

  private:
    using Bsdf = typename Surface::Bsdf;

    static std::uint32_t vertex_of(int depth) { return static_cast<std::uint32_t>(depth); }

    /// Where what is learned here goes.
    std::uint32_t record_region(const PathKey& path, int depth, const Vec3& p, std::uint32_t region,
                                Stream jitter) const {
        return settings_.jitter_records ? guide_.jittered_region(p, region, draw(path, vertex_of(depth), jitter))
                                        : region;
    }

    Rgb end(const Rgb& radiance, const char* why) {
        observer_.end(why);
        return radiance;
    }

    /// What the path brings that met `emitted`, weighted against next event, which finds that with the density
    /// `next_event_pdf()`.
    template <class Pdf>
    Rgb met(const Rgb& emitted, int depth, float scatter_pdf, const Rgb& throughput, Pdf next_event_pdf) {
        if (is_black(emitted) || (depth == 1 && settings_.hide_emitters)) return Rgb(0.0f);
        float light_pdf = 0.0f, weight = 1.0f;
        if (settings_.next_event && depth > 1) {
            light_pdf = next_event_pdf();
            weight = mis_weight(settings_.mis, scatter_pdf, light_pdf);
        }
        const Rgb weighted = emitted * weight;
        if constexpr (kRecord) recorder_.add_emission(weighted);
        observer_.emission(emitted, light_pdf, weight, throughput * weighted);
        return throughput * weighted;
    }

    // Emitters are met once in a path or never. Out of line and by value, what they may be (textured, an image around
    // the scene) costs the other vertices nothing, not even registers.

    [[gnu::noinline]] Rgb from_emitter(const Hit& hit, Vec3 direction, Vec3 scatter_point, int depth, float scatter_pdf,
                                       Rgb throughput) {
        const Emitters& emitters = scene_.emitters();
        return met(emitters.emitted(hit, -direction), depth, scatter_pdf, throughput,
                   [&] { return emitters.pdf_direct(scatter_point, direction, hit); });
    }

    [[gnu::noinline]] Rgb from_infinity(Vec3 direction, int depth, float scatter_pdf, Rgb throughput) {
        assert(scene_.effects().environment);
        const Emitters& emitters = scene_.emitters();
        return met(emitters.environment(direction), depth, scatter_pdf, throughput,
                   [&] { return emitters.pdf_environment(direction); });
    }

    /// What a sampled emitter sends via this surface against the incoming ray, weighted against scattering.
    Rgb next_event(const PathKey& path, int depth, const Hit& hit, const Surface& surface,
                   const GuidedSampling<Bsdf, kGuided>& sampling, std::uint32_t region, const Rgb& throughput) {
        const Draw random = draw(path, vertex_of(depth), Stream::light);
        const DirectSample light = settings_.delta_alone ? scene_.emitters().sample_delta(hit.p, random)
                                                         : scene_.emitters().sample_direct(hit.p, random);
        if (!(light.pdf > 0.0f) || is_black(light.radiance)) return Rgb(0.0f);
        const Vec3 wi = surface.frame().to_local(light.wi);
        const BsdfValue bsdf = surface.bsdf().value(surface.wo(), wi);
        if (is_black(bsdf.f_cos)) return Rgb(0.0f);
        if (settings_.strict_normals && dot(surface.ng(), light.wi) * wi.z <= 0.0f) return Rgb(0.0f);
        ++stats_.shadow_rays;
        if (shadowed(hit, light)) return Rgb(0.0f);

        // Scattering never meets a light without extent: its samples are weighted alone and teach the guide nothing.
        const bool record = kRecord && settings_.record_light_samples && !light.delta;
        std::uint32_t code = 0;
        if (kGuided || record) code = direction_to_code(light.wi);
        const float scatter_pdf = light.delta ? 0.0f : sampling.pdf(bsdf.pdf, code);
        const float weight = mis_weight(settings_.mis, light.pdf, scatter_pdf);
        const Rgb reflected = bsdf.f_cos * light.radiance * (weight / light.pdf);
        if (record)
            recorder_.add_light_sample(record_region(path, depth, hit.p, region, Stream::light_jitter), code,
                                       average(light.radiance) * weight, light.pdf, vertex_of(depth));
        observer_.next_event(light, scatter_pdf, weight, throughput * reflected);
        return reflected;
    }

    /// Both ends of the segment are moved off their surfaces towards each other.
    bool shadowed(const Hit& hit, const DirectSample& light) const {
        Ray shadow = {offset_origin(hit, light.wi), light.wi};
        if (!light.to_environment()) {
            shadow.direction = offset_origin(light.on_light, -light.wi) - shadow.origin;
            if (!(dot(shadow.direction, light.wi) > 0.0f))
                return false;  // closer than the offsets: nothing fits between
            shadow.length = 1.0f;
        }
        return scene_.geometry().occluded(shadow);
    }

    const TraceScene& scene_;
    const Guide& guide_;
    const PathSettings settings_;
    TraceStats& stats_;
    [[no_unique_address]] typename Surface::Scratch scratch_;
    PathRecorder recorder_;
    Observer observer_;
};

}  // namespace treefarm
