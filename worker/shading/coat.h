// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/math/warp.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Probability of sampling a coat that reflects the share `reflected` of what arrives, over one with the share of
/// `weight` in what is sent back.
inline float coat_probability(float reflected, float weight) {
    const float coat = reflected * weight, rest = (1.0f - reflected) * (1.0f - weight);
    return coat + rest > 0.0f ? coat / (coat + rest) : 0.0f;
}

/// What smooth and rough plastic share: a diffuse base under a dielectric coat.
struct CoatedBase {
    /// albedo / (1 - albedo fdr), or albedo / (1 - fdr) if linear, over eta^2: diffuse interreflection below the coat,
    /// fdr being the share that the coat sends back inside.
    Rgb base{0.0f};
    float specular_weight = 0.5f;  ///< luminance of the coat over that of coat and base: steers sampling only

    float probability(float reflected) const { return coat_probability(reflected, specular_weight); }

    /// f cos(wi) of the base below a coat that lets the shares `in` and `out` through.
    Rgb f_cos(const Vec3& wi, float in, float out) const { return base * (wi.z * kInvPi * in * out); }
};

/// The base of plastic with this albedo, where the coat does not send back the share `escapes` of diffuse light from
/// inside: 1 - fdr.
inline Rgb coated_base(const Rgb& albedo, float escapes, float eta, bool nonlinear) {
    const float inverse = 1.0f / (eta * eta);
    // Of extreme indices next to nothing enters, or leaves: the base stays finite, and what `in` and `out` leave of it
    // is nothing.
    constexpr float kMost = 1e15f;
    const auto channel = [&](float a) {
        const float lost = nonlinear ? (1.0f - a) + a * escapes : escapes;  // 1 - a fdr
        return lost > 0.0f ? std::min(a * inverse / lost, kMost) : 0.0f;
    };
    return {channel(albedo.x), channel(albedo.y), channel(albedo.z)};
}

}  // namespace treefarm
