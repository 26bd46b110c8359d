// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "worker/integrators/integrators.h"
#include "worker/integrators/sample_loop.h"
#include "worker/integrators/subpath/mis.h"
#include "worker/integrators/subpath/surface_light.h"

namespace treefarm {

namespace {

/// Estimator of direct light over one kind of surface: DiffuseSurface or GeneralSurface.
template <class Surface>
class DirectLight {
  public:
    DirectLight(const TraceScene& scene, const Resolved::Integrator& job, TraceStats& stats)
        : scene_(scene), job_(job), stats_(stats), scratch_(Surface::make_scratch(scene)) {}

    /// Radiance along a camera ray. Sample i of a surface uses the random numbers of the path's vertex 1 + i.
    Rgb radiance(const Numbers auto& numbers, const Ray& ray) {
        Hit hit;
        ++stats_.rays;
        const bool found = scene_.geometry().intersect(ray, hit);
        Rgb sum(0.0f);
        if (!job_.hide_emitters) sum += emitted(scene_.emitters(), ray, found ? &hit : nullptr);
        if (!found || job_.max_depth == 1) return sum;
        scene_.geometry().keep_inside(hit, ray);
        const Surface surface(scene_, hit, -ray.direction, scratch_);
        if (surface.black()) return sum;
        if (job_.strict_normals && -dot(surface.ng(), ray.direction) * surface.wo().z < 0.0f) return sum;
        ++stats_.vertices;
        for (int i = 0; surface.smooth() && i < job_.emitter_samples; ++i)
            sum += emitter_sample(hit, surface, draw(numbers, vertex(i), Stream::light));
        for (int i = 0; i < job_.bsdf_samples; ++i)
            sum += bsdf_sample(hit, surface, draw(numbers, vertex(i), Stream::scatter));
        return sum;
    }

  private:
    static std::uint32_t vertex(int sample) { return 1u + static_cast<std::uint32_t>(sample); }

    Rgb emitter_sample(const Hit& hit, const Surface& surface, const Draw& random) const {
        const DirectSample sample = scene_.emitters().sample_direct(receiver_at(hit, surface), random);
        const LightAtSurface light = light_at_surface(scene_, hit, surface, sample, job_.strict_normals, stats_);
        if (is_black(light.reflected)) return Rgb(0.0f);
        return light.reflected * (weight(emitters_ * light.pdf, bsdfs_ * light.bsdf_pdf) / (emitters_ * light.pdf));
    }

    Rgb bsdf_sample(const Hit& hit, const Surface& surface, const Draw& random) const {
        const BsdfSample sample = sample_bsdf(surface, random);
        if (!(sample.pdf > 0.0f) || is_black(sample.f_cos)) return Rgb(0.0f);
        const Vec3 direction = surface.frame().to_world(sample.wi);
        if (job_.strict_normals && !normals_agree(surface, direction, sample.wi.z)) return Rgb(0.0f);
        const Ray ray{offset_origin(hit, direction), direction};
        Hit next;
        ++stats_.rays;
        const Hit* const arrival = scene_.geometry().intersect(ray, next) ? &next : nullptr;
        const Rgb light = emitted(scene_.emitters(), ray, arrival);
        if (is_black(light)) return Rgb(0.0f);
        // Emitter sampling has density 0 at a delta lobe's direction.
        const float pdf = sample.delta ? std::numeric_limits<float>::infinity() : bsdfs_ * sample.pdf;
        const float emitter = emitters_ > 0.0f
                                  ? emitters_ * emitter_pdf(scene_.emitters(), receiver_at(hit, surface), ray, arrival)
                                  : 0.0f;
        return sample.f_cos * (1.0f / (bsdfs_ * sample.pdf)) * (light * weight(pdf, emitter));
    }

    float weight(float own, float other) const { return mis_weight(job_.mis, own, other); }

    const TraceScene& scene_;
    const Resolved::Integrator& job_;
    TraceStats& stats_;
    typename Surface::Scratch scratch_;
    const float emitters_ = static_cast<float>(job_.emitter_samples), bsdfs_ = static_cast<float>(job_.bsdf_samples);
};

}  // namespace

RenderUnit prepare_direct(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    return [scene = std::move(scene), job](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                           UnitOutput& output) {
        with_surface(*scene, [&]<class Surface>() {
            DirectLight<Surface> light(*scene, job.integrator, output.stats);
            render_samples(*scene, job, pass, unit, output,
                           [&](const PathKey& key, const Ray& ray) { return light.radiance(key, ray); });
        });
    };
}

}  // namespace treefarm
