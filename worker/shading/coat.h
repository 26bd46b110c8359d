// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/math/warp.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Probability of sampling the coat, which reflects the fraction `reflected` of the arriving light; `weight`: the
/// coat's fraction of the light sent back by coat and base.
inline float coat_probability(float reflected, float weight) {
    const float coat = reflected * weight, rest = (1.0f - reflected) * (1.0f - weight);
    return coat + rest > 0.0f ? coat / (coat + rest) : 0.0f;
}

/// Common part of smooth and rough plastic: a diffuse base under a dielectric coat.
struct CoatedBase {
    /// albedo / (1 - albedo fdr), or albedo / (1 - fdr) if linear, over eta^2: diffuse interreflection below the coat;
    /// fdr: fraction of diffuse light that the coat reflects back inside.
    Rgb base{0.0f};
    float specular_weight = 0.5f;  ///< luminance of the coat over that of coat and base: affects sampling only

    float probability(float reflected) const { return coat_probability(reflected, specular_weight); }

    /// f cos(wi) of the base below a coat with transmittances `in` and `out`.
    Rgb f_cos(const Vec3& wi, float in, float out) const { return base * (wi.z * kInvPi * in * out); }
};

/// Base of plastic with this albedo; `escapes`: fraction 1 - fdr of diffuse light that leaves the coat from inside.
inline Rgb coated_base(const Rgb& albedo, float escapes, float eta, bool nonlinear) {
    const float inverse = 1.0f / (eta * eta);
    // At extreme indices almost nothing enters or leaves: the base stays finite, and `in` and `out` reduce it to
    // nothing.
    constexpr float kMost = 1e15f;
    const auto channel = [&](float a) {
        const float lost = nonlinear ? (1.0f - a) + a * escapes : escapes;  // 1 - a fdr
        return lost > 0.0f ? std::min(a * inverse / lost, kMost) : 0.0f;
    };
    return {channel(albedo.x), channel(albedo.y), channel(albedo.z)};
}

}  // namespace treefarm
