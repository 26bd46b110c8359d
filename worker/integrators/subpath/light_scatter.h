// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/subpath/surface_light.h"

namespace treefarm {

// What light that comes from an emitter does at a surface. The BSDF is asked in its true role, as the walk from the
// camera would ask it: wo is where light goes, wi where it comes from. So nothing need be reciprocal, tilted normals
// stay inside the BSDF, and refraction scales radiance on its own (docs/design/transport.md).

/// |w . ng| of a unit direction.
inline float geometric_cosine(const Hit& hit, const Vec3& w) {
    return std::abs(dot(hit.ng, w));
}

/// Scattering from `in`, where light comes from, to `out`.
struct LightScattering {
    Rgb f{0.0f};            ///< BSDF times |out . ng|: f |in . n| |out . ng| / |in . ng|, per steradian
    float reverse_pdf = 0;  ///< with which the walk from the camera, here from `out`, draws `in`; per steradian
};

/// Scattering of the smooth lobes between two unit directions that point away from the surface. `scratch`: of this call
/// alone; what else was looked up in it is gone.
template <class Surface>
LightScattering light_scattering(const TraceScene& scene, const Hit& hit, const Vec3& in, const Vec3& out,
                                 bool strict_normals, typename Surface::Scratch& scratch) {
    const float in_cosine = geometric_cosine(hit, in);
    if (!(in_cosine > 0.0f)) return {};
    const Surface surface(scene, hit, out, scratch);
    if (surface.black()) return {};
    const Vec3 wi = surface.frame().to_local(in);
    if (strict_normals && !(normals_agree(surface, out, surface.wo().z) && normals_agree(surface, in, wi.z))) return {};
    const BsdfValue value = surface.bsdf().value(surface.wo(), wi);
    return {value.f_cos * (geometric_cosine(hit, out) / in_cosine), value.pdf};
}

/// What the weight of a delta lobe is multiplied by that sample() drew from `wo` as `wi`, by `random`, if light came
/// from wo and goes to wi. Power goes through a boundary whole, where radiance is scaled; and lobes about tilted
/// normals ask which direction is which. The geometric cosines are not in it.
float delta_role(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, const BsdfRandom& random);

/// A step of a light path.
struct LightStep {
    bool goes_on = false;
    Vec3 direction{0.0f};   ///< unit, in world space
    Rgb weight{0.0f};       ///< of the scattering over its density
    float pdf = 0;          ///< per steradian; of a delta lobe its probability
    float reverse_pdf = 0;  ///< of the walk from the camera; of a delta lobe 0: it has no density
    bool delta = false;
};

/// Draws the direction in which light that came from `in` goes on. `surface`: built with `in` as where light goes,
/// since BSDFs are sampled from there; `scratch` is another one than its own.
template <class Surface>
LightStep scatter_light(const TraceScene& scene, const Hit& hit, const Surface& surface, const Vec3& in,
                        bool strict_normals, const Draw& random, typename Surface::Scratch& scratch) {
    LightStep step;
    const BsdfSample sample = sample_bsdf(surface, random);
    const float in_cosine = geometric_cosine(hit, in);
    if (!(sample.pdf > 0.0f) || is_black(sample.f_cos) || !(in_cosine > 0.0f)) return step;
    step.direction = surface.frame().to_world(sample.wi);
    step.pdf = sample.pdf;
    step.delta = sample.delta;
    if (strict_normals &&
        !(normals_agree(surface, in, surface.wo().z) && normals_agree(surface, step.direction, sample.wi.z)))
        return step;
    if (sample.delta) {
        float factor = geometric_cosine(hit, step.direction) / (in_cosine * sample.pdf);
        if constexpr (Surface::kGeneral)
            factor *= delta_role(surface.bsdf(), surface.wo(), sample.wi,
                                 {to_unit(random[1]), Vec2(to_unit(random[2]), to_unit(random[3]))});
        step.weight = sample.f_cos * factor;
    } else {
        const LightScattering scattering =
            light_scattering<Surface>(scene, hit, in, step.direction, strict_normals, scratch);
        step.weight = scattering.f * (1.0f / sample.pdf);
        step.reverse_pdf = scattering.reverse_pdf;
    }
    step.goes_on = !is_black(step.weight);
    return step;
}

}  // namespace treefarm
