// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "common/film/trace_stats.h"
#include "worker/scene/surface.h"

namespace treefarm {

// Light at a surface, one ray at a time: the components of integrators without batches.

/// Calls f.operator()<Surface>() with the surface class of the scene: diffuse or general.
template <class F>
void with_surface(const TraceScene& scene, F f) {
    if (scene.plainly_diffuse())
        f.template operator()<DiffuseSurface>();
    else
        f.template operator()<GeneralSurface>();
}

/// Emitted radiance along a ray: that of the surface hit, or that from infinity if `arrival` is nullptr.
inline Rgb emitted(const Emitters& emitters, const Ray& ray, const Hit* arrival) {
    return arrival ? emitters.emitted(*arrival, -ray.direction) : emitters.environment(ray.direction);
}

/// Receiver of emitters' light at a surface point.
template <class Surface>
LightReceiver receiver_at(const Hit& hit, const Surface& surface) {
    const Vec3& front = surface.front();
    return {hit.p, nullptr, surface.transmits() ? nullptr : &front};
}

/// Density per steradian with which emitter sampling at `from` finds the emission at the ray's end.
inline float emitter_pdf(const Emitters& emitters, const LightReceiver& from, const Ray& ray, const Hit* arrival) {
    return arrival ? emitters.pdf_direct(from, ray.direction, *arrival) : emitters.pdf_environment(from, ray.direction);
}

/// Direction sampled from a surface's BSDF; density 0 if there is none.
template <class Surface>
BsdfSample sample_bsdf(const Surface& surface, const Draw& random) {
    return surface.bsdf().sample(surface.wo(), {to_unit(random[1]), Vec2(to_unit(random[2]), to_unit(random[3]))});
}

/// Whether `world` is on the same side of the geometric and the shading normal; `local_z`: its cosine with the shading
/// normal.
template <class Surface>
bool normals_agree(const Surface& surface, const Vec3& world, float local_z) {
    return dot(surface.ng(), world) * local_z > 0.0f;
}

/// Direct light of one emitter sample at a surface.
struct LightAtSurface {
    Rgb reflected{0.0f};  ///< f |cos| times radiance; black if occluded or not reflected
    float pdf = 0;        ///< of the emitter sample, per steradian; its probability if the emitter has no extent
    float bsdf_pdf = 0;   ///< density of scattering in that direction; 0 for an emitter without extent
};

/// Direct light of an emitter sample at `hit`, with its shadow ray.
template <class Surface>
LightAtSurface light_at_surface(const TraceScene& scene, const Hit& hit, const Surface& surface,
                                const DirectSample& light, bool strict_normals, TraceStats& stats) {
    LightAtSurface result;
    if (!(light.pdf > 0.0f) || light.black()) return result;
    const BsdfValue bsdf = surface.bsdf().value(surface.wo(), surface.frame().to_local(light.wi));
    if (is_black(bsdf.f_cos)) return result;
    if (strict_normals && !normals_agree(surface, light.wi, dot(surface.frame().n, light.wi))) return result;
    ++stats.shadow_rays;
    const Ray ray = shadow_ray(hit, light);
    bool hidden;
    scene.geometry().occluded({&ray, 1}, &hidden);
    if (hidden) return result;
    const Rgb radiance = light.from_environment ? scene.emitters().environment(light.wi) : light.radiance;
    return {bsdf.f_cos * radiance, light.pdf, light.delta ? 0.0f : bsdf.pdf};
}

}  // namespace treefarm
