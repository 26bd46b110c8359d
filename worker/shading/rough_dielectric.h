// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/dielectric.h"
#include "worker/shading/dielectric.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/null.h"
#include "worker/shading/rough_reflection.h"

namespace treefarm {

/// BSDF of a rough boundary between transparent media (Walter et al. 2007), radiance scaled as in dielectric.h.
struct RoughDielectricBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kTransmittingLobe | kViewLobe;

    float eta = 1.5f;  ///< index of refraction of the far side over that of wo's side; not within 1e-4 of 1
    Rgb reflectance{1.0f}, transmittance{1.0f};
    Microfacet facets;

    float refraction() const { return eta; }

    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (wi.z > 0.0f) {
            const RoughReflection r = rough_reflection(facets, wo, wi);
            const float f = fresnel_dielectric(r.cos_o, eta).reflectance;
            return {reflectance * (f * r.f_cos), f * r.pdf};
        }
        return wi.z < 0.0f ? refracted(wo, wi) : BsdfValue{};
    }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Vec3 m = facets.sample_visible(wo, random.point);
        const float cos_o = dot(wo, m);
        if (!(cos_o > 0.0f)) return {};
        const DielectricFresnel f = fresnel_dielectric(std::min(1.0f, cos_o), eta);
        const bool reflects = random.lobe < f.reflectance;
        const Vec3 wi = reflects ? reflected(wo, m) : refract(wo, m, cos_o, f.cos_transmitted, eta);
        if (reflects != (wi.z > 0.0f)) return {};
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    BsdfValue refracted(const Vec3& wo, const Vec3& wi) const {
        Vec3 h = wo + wi * eta;
        const float length = std::sqrt(dot(h, h));
        if (!(length > 0.0f)) return {};
        h *= std::copysign(1.0f / length, h.z);
        const float cos_o = dot(wo, h), cos_i = -dot(wi, h);
        if (!(cos_o > 0.0f && cos_i > 0.0f && h.z > 0.0f)) return {};
        const float transmitted = 1.0f - fresnel_dielectric(std::min(1.0f, cos_o), eta).reflectance;
        const float compression = cos_o - eta * cos_i;
        // Density of the visible normal times that of the refracted direction for it, both over eta^2.
        const float p =
            transmitted * facets.density(h) * (cos_o / facets.projected_area(wo)) * cos_i / (compression * compression);
        return {transmittance * (p * facets.masking({wi.x, wi.y, -wi.z})), p * eta * eta};
    }
};

/// Whether refraction is resolved. An index nearer to 1 bends rays by less than float's resolution, and the half vector
/// would be rounding error.
inline bool refracts(float eta) {
    return std::abs(eta - 1.0f) > 1e-4f;
}

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const DielectricMaterial& m, const Context& at) {
    const Rgb reflectance = at.color(m.specular_reflectance), transmittance = at.color(m.specular_transmittance);
    if (!refracts(m.eta)) return {NullBsdf{transmittance}};
    const float eta = at.back ? 1.0f / m.eta : m.eta;
    if (m.roughness.smooth()) return {DielectricBsdf{eta, reflectance, transmittance}};
    return {RoughDielectricBsdf{eta, reflectance, transmittance, at.facets(m.roughness)}};
}

}  // namespace treefarm
