// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/conductor.h"
#include "worker/shading/conductor.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/rough_reflection.h"

namespace treefarm {

/// BSDF of a rough metal (thesis 2.8 to 2.12; Walter et al. 2007): f = F D G1(wo) G1(wi) / (4 cos cos).
struct RoughConductorBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kViewLobe;

    Rgb eta{0.0f}, k{1.0f}, reflectance{1.0f};
    Microfacet facets;

    [[gnu::always_inline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        const RoughReflection r = rough_reflection(facets, wo, wi);
        return {reflectance * fresnel_conductor(r.cos_o, eta, k) * r.f_cos, r.pdf};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Vec3 wi = reflected(wo, facets.sample_visible(wo, random.point));
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const ConductorMaterial& m, const Context& at) {
    const Rgb reflectance = at.color(m.specular_reflectance);
    if (m.roughness.smooth()) return {ConductorBsdf{m.eta, m.k, reflectance}};
    return {RoughConductorBsdf{m.eta, m.k, reflectance, at.facets(m.roughness)}};
}

}  // namespace treefarm
