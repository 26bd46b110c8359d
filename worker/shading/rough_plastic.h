// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/plastic.h"
#include "worker/shading/bsdf_needs.h"
#include "worker/shading/coat.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/plastic.h"
#include "worker/shading/rough_reflection.h"
#include "worker/shading/rough_transmittance.h"

namespace treefarm {

/// BSDF of a diffuse base under a rough dielectric coat.
struct RoughPlasticBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kWideLobe | kViewLobe;

    float eta = 1.5f;
    Rgb specular{1.0f};
    CoatedBase coated;
    Microfacet facets;  ///< isotropic
    const RoughTransmittance* coat = nullptr;

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        const RoughReflection r = rough_reflection(facets, wo, wi);
        const float out = coat->at(wo.z);
        const float probability = coated.probability(1.0f - out);
        return {
            specular * (fresnel_dielectric(r.cos_o, eta).reflectance * r.f_cos) + coated.f_cos(wi, coat->at(wi.z), out),
            probability * r.pdf + (1.0f - probability) * cosine_hemisphere_pdf(wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const bool coat_chosen = random.lobe < coated.probability(1.0f - coat->at(wo.z));
        const Vec3 wi = coat_chosen ? reflected(wo, facets.sample_visible(wo, random.point)) : random.cosine;
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }
};

template <>
struct BsdfNeeds<PlasticMaterial> : NoBsdfNeeds {
    static constexpr bool kCoat = true;
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const PlasticMaterial& m, const Context& at) {
    const Rgb diffuse = at.color(m.diffuse_reflectance), specular = at.color(m.specular_reflectance);
    const float coat = luminance(specular), base = luminance(diffuse);
    if (!(coat + base > 0.0f)) return {};
    CoatedBase coated{Rgb(0.0f), coat / (coat + base)};
    if (m.roughness.smooth()) {
        coated.base = coated_base(diffuse, at.smooth_escapes(), m.eta, m.nonlinear);
        return {PlasticBsdf{m.eta, specular, coated}};
    }
    const Microfacet rough = at.facets(m.roughness);
    const RoughTransmittance* transmittance = at.coat(rough);
    coated.base = coated_base(diffuse, transmittance->escapes(m.single_return), m.eta, m.nonlinear);
    return {RoughPlasticBsdf{m.eta, specular, coated, rough, transmittance}};
}

}  // namespace treefarm
