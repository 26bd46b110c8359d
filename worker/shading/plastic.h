// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/shading/coat.h"
#include "worker/shading/fresnel.h"

namespace treefarm {

/// BSDF of a diffuse base under a smooth dielectric coat.
struct PlasticBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kWideLobe | kDeltaLobe;

    float eta = 1.5f;
    Rgb specular{1.0f};
    CoatedBase coated;

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        const float out = fresnel_dielectric(wo.z, eta).reflectance, in = fresnel_dielectric(wi.z, eta).reflectance;
        return {coated.f_cos(wi, 1.0f - in, 1.0f - out),
                (1.0f - coated.probability(out)) * cosine_hemisphere_pdf(wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const float f = fresnel_dielectric(wo.z, eta).reflectance;
        const float probability = coated.probability(f);
        if (random.lobe < probability) return {{-wo.x, -wo.y, wo.z}, probability, specular * f, true};
        const Vec3 wi = random.cosine;
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }
};

}  // namespace treefarm
