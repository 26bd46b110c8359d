// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/elementary.h"
#include "common/math/exponential.h"
#include "common/math/frame.h"
#include "common/math/warp.h"
#include "common/scene/kinds/materials/phong.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Modified Phong BSDF (Lafortune and Willems 1994): a diffuse base, and a power of the cosine with the mirrored
/// direction.
struct PhongBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kWideLobe | kViewLobe;

    Rgb diffuse{0.0f}, specular{0.0f};
    float exponent = 30;
    float specular_probability = 0.5f;  ///< of sampling the lobe; affects sampling only

    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        // 1 - cos without cancellation: a lobe may be narrower than the resolution of a cosine near 1.
        const Vec3 apart = wi - mirrored(wo);
        const float fallen = 0.5f * dot(apart, apart);
        const float lobe = fallen < 1.0f - 0x1p-24f ? exp_negative(exponent * minus_log_one_minus(fallen)) : 0.0f;
        const float scale = lobe * (0.5f * kInvPi);
        return {(diffuse * kInvPi + specular * (scale * (exponent + 2.0f))) * wi.z,
                specular_probability * scale * (exponent + 1.0f) +
                    (1.0f - specular_probability) * cosine_hemisphere_pdf(wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        Vec3 wi = random.cosine;
        if (random.lobe < specular_probability) {
            // cos = (1 - u)^(1 / (n + 1)).
            const float t = minus_log_one_minus(std::min(random.point.x, 1.0f - 0x1p-24f)) / (exponent + 1.0f);
            const float cosine = exp_negative(t), sine = std::sqrt(one_minus_exp_negative(2.0f * t));
            const SinCos phi = sincos_turn(random.point.y);
            wi = Frame(mirrored(wo)).to_world({sine * phi.cos, sine * phi.sin, cosine});
        }
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    static Vec3 mirrored(const Vec3& wo) { return {-wo.x, -wo.y, wo.z}; }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const PhongMaterial& m, const Context& at) {
    const Rgb diffuse = at.color(m.diffuse_reflectance), specular = at.color(m.specular_reflectance);
    const float base = luminance(diffuse), lobe = luminance(specular);
    if (!(base + lobe > 0.0f)) return {};
    return {PhongBsdf{diffuse, specular, at.number(m.exponent), lobe / (base + lobe)}};
}

}  // namespace treefarm
