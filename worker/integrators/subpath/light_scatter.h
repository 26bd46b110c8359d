// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/subpath/surface_light.h"

namespace treefarm {

// Scattering of light from an emitter at a surface. The BSDF is evaluated in the camera walk's orientation: wo is where
// light goes, wi where it comes from. So it need not be reciprocal; tilted normals and the scaling of refracted
// radiance stay inside the BSDF (docs/design/transport.md).

/// |w . ng| of a unit direction.
inline float geometric_cosine(const Hit& hit, const Vec3& w) {
    return std::abs(dot(hit.ng, w));
}

/// Scattering from `in`, where light comes from, to `out`.
struct LightScattering {
    Rgb f{0.0f};            ///< BSDF times |out . ng|: f |in . n| |out . ng| / |in . ng|, per steradian
    float reverse_pdf = 0;  ///< density of the camera walk, arriving from `out`, for `in`; per steradian
};

/// Scattering by the smooth lobes between two unit directions that point away from the surface. `scratch`: for this
/// call alone; its former contents are lost.
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

/// Factor on the weight of a delta lobe that sample() drew as `wi` from `wo` by `random`, for light that comes from wo
/// and goes to wi. Power passes a boundary unscaled, unlike radiance; lobes about tilted normals depend on the
/// orientation, too. Geometric cosines are not included.
float delta_role(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, const BsdfRandom& random);

/// A step of a light path.
struct LightStep {
    bool goes_on = false;
    Vec3 direction{0.0f};   ///< unit, in world space
    Rgb weight{0.0f};       ///< scattering over its density
    float pdf = 0;          ///< per steradian; of a delta lobe its probability
    float reverse_pdf = 0;  ///< density of the camera walk; 0 for a delta lobe, which has none
    bool delta = false;
};

/// Draws the direction in which light that came from `in` continues. `surface`: constructed with `in` as its wo, since
/// BSDFs are sampled from there; `scratch`: not the surface's own.
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
