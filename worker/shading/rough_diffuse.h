// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/elementary.h"
#include "common/math/warp.h"
#include "common/scene/kinds/materials/rough_diffuse.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Oren-Nayar BSDF (1994): Lambertian facets with shadowing, masking and, unless `fast`, interreflection. Sampled like
/// a diffuse surface.
struct RoughDiffuseBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kWideLobe;

    Rgb reflectance{0.0f};
    float sigma2 = 0;  ///< variance of the facets' slope angles
    bool fast = false;

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        const float lambert = wi.z * kInvPi;
        return {fast ? reflectance * (lambert * short_form(wo, wi)) : long_form(wo, wi) * lambert,
                cosine_hemisphere_pdf(wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Vec3 wi = random.cosine;
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    static float sine(const Vec3& w) { return std::sqrt(w.x * w.x + w.y * w.y); }

    static float cos_azimuth(const Vec3& wo, const Vec3& wi, float sin_o, float sin_i) {
        const float both = sin_o * sin_i;
        return both > 1e-8f ? std::clamp((wo.x * wi.x + wo.y * wi.y) / both, -1.0f, 1.0f) : 0.0f;
    }

    /// Equation 30.
    float short_form(const Vec3& wo, const Vec3& wi) const {
        const float sin_o = sine(wo), sin_i = sine(wi);
        const float a = 1.0f - 0.5f * sigma2 / (sigma2 + 0.33f), b = 0.45f * sigma2 / (sigma2 + 0.09f);
        // sin alpha tan beta: alpha is the larger, beta the smaller angle with the normal.
        const float angles = sin_o * sin_i / std::max(wo.z, wi.z);
        return a + b * std::max(0.0f, cos_azimuth(wo, wi, sin_o, sin_i)) * angles;
    }

    /// Equations 27 to 29.
    Rgb long_form(const Vec3& wo, const Vec3& wi) const {
        const float sin_o = sine(wo), sin_i = sine(wi);
        const float theta_o = kPi * acos_half_turn(wo.z), theta_i = kPi * acos_half_turn(wi.z);
        const float alpha = std::max(theta_o, theta_i), beta = std::min(theta_o, theta_i);
        const float sin_alpha = std::max(sin_o, sin_i), sin_beta = std::min(sin_o, sin_i);
        const float cos_alpha = std::min(wo.z, wi.z), cos_beta = std::max(wo.z, wi.z);
        const float cos_phi = cos_azimuth(wo, wi, sin_o, sin_i);
        const float ratio = sigma2 / (sigma2 + 0.09f), angles = 4.0f * kInvPi * kInvPi * alpha * beta;
        const float b = 2.0f * beta * kInvPi;
        const float c1 = 1.0f - 0.5f * sigma2 / (sigma2 + 0.33f);
        const float c2 = 0.45f * ratio * (cos_phi > 0.0f ? sin_alpha : sin_alpha - b * b * b);
        const float c3 = 0.125f * ratio * angles * angles;
        const float c4 = 0.17f * sigma2 / (sigma2 + 0.13f);
        const float tan_half = (sin_alpha + sin_beta) / (cos_alpha + cos_beta);
        const float once = c1 + cos_phi * c2 * sin_beta / cos_beta + (1.0f - std::abs(cos_phi)) * c3 * tan_half;
        const float twice = c4 * (1.0f - cos_phi * b * b);
        // Equation 27's fit falls below 0 on very rough surfaces lit at grazing angles.
        return reflectance * std::max(0.0f, once) + reflectance * reflectance * twice;
    }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const RoughDiffuseMaterial& m, const Context& at) {
    const Rgb albedo = at.color(m.reflectance);
    if (is_black(albedo)) return {};
    // From slopes to angles: a fit of Mitsuba's authors, valid up to 0.5.
    const float alpha = at.number(m.alpha);
    return {RoughDiffuseBsdf{albedo, 0.5f * alpha * alpha, m.fast}};
}

}  // namespace treefarm
