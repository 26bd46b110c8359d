// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/elementary.h"
#include "common/math/exponential.h"
#include "common/math/warp.h"
#include "common/scene/kinds/materials/ward.h"
#include "worker/shading/rough_reflection.h"

namespace treefarm {

/// Ward's BSDF (1992), in three normalisations, over a diffuse base. Half vectors are sampled from Ward's Gaussian of
/// slopes.
struct WardBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kWideLobe | kViewLobe;

    Rgb diffuse{0.0f}, specular{0.0f};
    float alpha_u = 0.1f, alpha_v = 0.1f;
    WardVariant variant = WardVariant::balanced;
    float specular_probability = 0.5f;  ///< of sampling the lobe; affects sampling only

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        const float diffuse_probability = 1.0f - specular_probability;
        BsdfValue result{diffuse * (wi.z * kInvPi), diffuse_probability * cosine_hemisphere_pdf(wi.z)};
        const float h_z = wo.z + wi.z, u = (wo.x + wi.x) / h_z, v = (wo.y + wi.y) / h_z;
        const float slope_u = u / alpha_u, slope_v = v / alpha_v;
        const float gauss = exp_negative(slope_u * slope_u + slope_v * slope_v) * kInvPi / (alpha_u * alpha_v);
        if (!(gauss > 0.0f)) return result;
        const float stretch = 1.0f + u * u + v * v;  // |h|^2 / h.z^2
        result.f_cos += specular * (gauss * normalised(wo.z, wi.z, h_z, stretch));
        result.pdf += specular_probability * (gauss * 0.5f * stretch / h_z);
        return result;
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        Vec3 wi = random.cosine;
        if (random.lobe < specular_probability) {
            const float r = std::sqrt(minus_log_one_minus(std::min(random.point.x, 1.0f - 0x1p-24f)));
            const SinCos phi = sincos_turn(random.point.y);
            wi = reflected(wo, normalize(Vec3(alpha_u * r * phi.cos, alpha_v * r * phi.sin, 1.0f)));
        }
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    /// Factor on the Gaussian, cos(wi) included. `h_z` and `stretch` are those of wo + wi. No division by the square of
    /// a small cosine.
    float normalised(float cos_o, float cos_i, float h_z, float stretch) const {
        switch (variant) {
            case WardVariant::ward:
                return 0.25f * std::sqrt(cos_i / cos_o);
            case WardVariant::duer:
                return 0.25f / cos_o;
            case WardVariant::balanced:
                break;
        }
        return cos_i / h_z * stretch / h_z;
    }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const WardMaterial& m, const Context& at) {
    const Rgb diffuse = at.color(m.diffuse_reflectance), specular = at.color(m.specular_reflectance);
    const float base = luminance(diffuse), lobe = luminance(specular);
    if (!(base + lobe > 0.0f)) return {};
    const Microfacet facets = at.facets(m.roughness);
    return {WardBsdf{diffuse, specular, facets.alpha_u, facets.alpha_v, m.variant, lobe / (base + lobe)}};
}

}  // namespace treefarm
