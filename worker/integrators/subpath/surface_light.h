// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "common/film/trace_stats.h"
#include "worker/scene/surface.h"

namespace treefarm {

// Light at a surface, one ray at a time: what integrators without batches are made of.

/// Calls f.operator()<Surface>() with the kind of surface that all of the scene's are of.
template <class F>
void with_surface(const TraceScene& scene, F f) {
    if (scene.plainly_diffuse())
        f.template operator()<DiffuseSurface>();
    else
        f.template operator()<GeneralSurface>();
}

/// Radiance that a ray brings back: what the surface where it arrived emits, or without one (nullptr) what comes from
/// infinity.
inline Rgb emitted(const Emitters& emitters, const Ray& ray, const Hit* arrival) {
    return arrival ? emitters.emitted(*arrival, -ray.direction) : emitters.environment(ray.direction);
}

/// A point of a surface that light of emitters is wanted at.
template <class Surface>
LightReceiver receiver_at(const Hit& hit, const Surface& surface) {
    const Vec3& front = surface.front();
    return {hit.p, nullptr, surface.transmits() ? nullptr : &front};
}

/// Density with which emitter sampling at `from` finds what emits there, per steradian.
inline float emitter_pdf(const Emitters& emitters, const LightReceiver& from, const Ray& ray, const Hit* arrival) {
    return arrival ? emitters.pdf_direct(from, ray.direction, *arrival) : emitters.pdf_environment(from, ray.direction);
}

/// A direction drawn from a surface's BSDF; its density is 0 if there is none.
template <class Surface>
BsdfSample sample_bsdf(const Surface& surface, const Draw& random) {
    return surface.bsdf().sample(surface.wo(), {to_unit(random[1]), Vec2(to_unit(random[2]), to_unit(random[3]))});
}

/// Whether geometric and shading normal agree on which side of a surface the direction `world` is, which has the
/// elevation `local_z` over the shading normal.
template <class Surface>
bool normals_agree(const Surface& surface, const Vec3& world, float local_z) {
    return dot(surface.ng(), world) * local_z > 0.0f;
}

/// Light of a sampled emitter at a surface.
struct LightAtSurface {
    Rgb reflected{0.0f};  ///< f |cos| times the radiance; black: none, or a shadow
    float pdf = 0;        ///< of the emitter's sample, per steradian; or the probability of one without extent
    float bsdf_pdf = 0;   ///< with which scattering goes the same way; 0 for an emitter without extent
};

/// Light of a sample of `emitters` seen from `hit`, if nothing lies between.
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
