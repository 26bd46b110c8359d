// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/elementary.h"
#include "common/math/vec.h"

namespace treefarm {

/// Fresnel reflection at a smooth boundary between two transparent media, for unpolarised light.
struct DielectricFresnel {
    float reflectance = 1;      ///< fraction of the power, in [0, 1]; 1: total internal reflection
    float cos_transmitted = 0;  ///< of the refracted ray with the normal of its side, >= 0
};

/// Fresnel's equations. `cos_i` in [0, 1]; `eta` is the index of refraction of the far side over that of the near side.
[[gnu::always_inline]] inline DielectricFresnel fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1.0f - cos_i) * (1.0f + cos_i) / (eta * eta);
    if (!(sin2_t < 1.0f)) return {};
    const float cos_t = std::sqrt(1.0f - sin2_t);
    const float s_sum = cos_i + eta * cos_t, p_sum = eta * cos_i + cos_t;
    if (!(s_sum > 0.0f) || !(p_sum > 0.0f)) return {};
    const float s = (cos_i - eta * cos_t) / s_sum, p = (eta * cos_i - cos_t) / p_sum;
    return {std::min(1.0f, 0.5f * (s * s + p * p)), cos_t};
}

/// Reflectance of one channel of a metal with complex index eta + i k relative to the outside, `cos_i` in [0, 1] (the
/// exact equations, as in Mitsuba 0.6). always_inline, since the compiler's own choice depends on unrelated code.
[[gnu::always_inline]] inline float fresnel_conductor(float cos_i, float eta, float k) {
    const float cos2 = cos_i * cos_i, sin2 = (1.0f - cos_i) * (1.0f + cos_i);
    const float re = eta * eta - k * k - sin2;
    const float a2_plus_b2 = std::sqrt(re * re + 4.0f * eta * eta * k * k);
    // a^2 = (a2_plus_b2 + re) / 2, by its conjugate where that cancels (docs/generated/hard-cases.md: 113-bit
    // arithmetic).
    const float product = eta * k;
    const float a2 =
        re > 0.0f ? 0.5f * (a2_plus_b2 + re) : 2.0f * product * (product / std::max(a2_plus_b2 - re, kLeastNormal));
    const float a = std::sqrt(a2);
    const float s_even = a2_plus_b2 + cos2, s_odd = 2.0f * a * cos_i;
    if (!(s_even + s_odd > 0.0f)) return 1.0f;
    const float s = (s_even - s_odd) / (s_even + s_odd);
    const float p_even = a2_plus_b2 * cos2 + sin2 * sin2, p_odd = s_odd * sin2;
    if (!(p_even + p_odd > 0.0f)) return s;
    return std::clamp(0.5f * s * (1.0f + (p_even - p_odd) / (p_even + p_odd)), 0.0f, 1.0f);
}

inline Rgb fresnel_conductor(float cos_i, const Rgb& eta, const Rgb& k) {
    return {fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
            fresnel_conductor(cos_i, eta.z, k.z)};
}

/// Direction refracted at a normal `m` on the side of `wo` (unit, cos_o = wo . m > 0).
inline Vec3 refract(const Vec3& wo, const Vec3& m, float cos_o, float cos_transmitted, float eta) {
    const float inverse = 1.0f / eta;
    return m * (cos_o * inverse - cos_transmitted) - wo * inverse;
}

}  // namespace treefarm
