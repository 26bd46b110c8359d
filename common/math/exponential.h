// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace treefarm {

/// Exponential exp(-x) for x >= 0, relative error below 3e-7 (reason: elementary.h). Exactly 0 from 87 on.
inline float exp_negative(float x) {
    if (!(x < 87.0f)) return 0.0f;
    // 2^-n e^-r with |r| <= ln 2 / 2; ln 2 is split so that n times its first part is exact.
    const float n = std::floor(x * 1.44269504088896340736f + 0.5f);
    const float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
    const float p =
        1.0f + r * (-1.0f + r * (0.5f + r * (-1.66666667e-1f +
                                             r * (4.16666667e-2f + r * (-8.33333333e-3f + r * 1.38888889e-3f)))));
    const auto exponent = static_cast<std::uint32_t>(127 - static_cast<int>(n));
    return p * std::bit_cast<float>(exponent << 23);
}

/// Difference 1 - exp(-x) for x >= 0, without cancellation near 0: relative error below 1e-6.
inline float one_minus_exp_negative(float x) {
    if (x < 0.1f) return x * (1.0f - x * (0.5f - x * (1.66666667e-1f - x * (4.16666667e-2f - x * 8.33333333e-3f))));
    return 1.0f - exp_negative(x);
}

/// Logarithm -ln(x) for normal x in (0, 1]; the absolute error is below 3e-7 of the larger of 1 and the result.
inline float minus_log(float x) {
    // x = 2^e m with m in [sqrt(1/2), sqrt(2)), and ln m = 2 artanh((m - 1) / (m + 1)).
    const auto shifted = std::bit_cast<std::uint32_t>(x) - 0x3f3504f3u;
    const auto exponent = static_cast<float>(static_cast<std::int32_t>(shifted) >> 23);
    const auto m = std::bit_cast<float>((shifted & 0x007fffffu) + 0x3f3504f3u);
    const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    const float log_m =
        2.0f * s * (1.0f + s2 * (3.33333333e-1f + s2 * (0.2f + s2 * (1.42857143e-1f + s2 * 1.11111111e-1f))));
    return -(exponent * 0.69314718055994530942f + log_m);
}

/// Logarithm -ln(1 - x) for x in [0, 1 - 2^-24], relative error below 1e-6.
inline float minus_log_one_minus(float x) {
    if (x < 0.03f)
        return x * (1.0f + x * (0.5f + x * (3.33333333e-1f + x * (0.25f + x * (0.2f + x * 1.66666667e-1f)))));
    return minus_log(1.0f - x);
}

inline constexpr std::array<float, 11> kErfcScaled = {
    0.2256758315f,   0.2256763169f, 0.2076007204f,  0.1718905719f, 0.1180951231f,   0.08712064143f,
    -0.05379316585f, 0.146803245f,  -0.2430417313f, 0.143841069f,  -0.02986862843f,
};

/// Scaled complementary error function exp(x^2) erfc(x) for x >= 0, relative error below 3e-7: t P(t) with t = 1 / (1 +
/// 0.4 x), fitted at Chebyshev nodes.
inline float erfc_scaled(float x) {
    const float t = 1.0f / (1.0f + 0.4f * x);
    float p = kErfcScaled.back();
    for (std::size_t i = kErfcScaled.size() - 1; i-- > 0;)
        p = p * t + kErfcScaled[i];
    return p * t;
}

}  // namespace treefarm
