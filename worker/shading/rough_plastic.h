#pragma once

#include "worker/shading/coat.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/rough_reflection.h"
#include "worker/shading/rough_transmittance.h"

namespace treefarm {

/// A diffuse base under a rough dielectric coat.
struct RoughPlasticBsdf {
    float eta = 1.5f;
    Rgb specular{1.0f};
    CoatedBase coated;
    Microfacet facets;  ///< isotropic
    const RoughTransmittance* coat = nullptr;

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        const RoughReflection r = rough_reflection(facets, wo, wi);
        const float out = coat->at(wo.z);
        const float probability = coated.coat_probability(1.0f - out);
        return {
            specular * (fresnel_dielectric(r.cos_o, eta).reflectance * r.f_cos) + coated.f_cos(wi, coat->at(wi.z), out),
            probability * r.pdf + (1.0f - probability) * cosine_hemisphere_pdf(wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const bool coat_chosen = random.lobe < coated.coat_probability(1.0f - coat->at(wo.z));
        const Vec3 wi = coat_chosen ? reflected(wo, facets.sample_visible(wo, random.place)) : random.cosine;
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }
};

}  // namespace treefarm
