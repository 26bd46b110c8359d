// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace treefarm {

/// Equals condition ? a : b, compiled without a branch: for conditions that cannot be predicted.
inline float select(bool condition, float a, float b) {
    const std::uint32_t mask = 0u - static_cast<std::uint32_t>(condition);
    return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) | (std::bit_cast<std::uint32_t>(b) & ~mask));
}

/// Equals -x if the condition holds, else x.
inline float negate_if(bool condition, float x) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) ^ (static_cast<std::uint32_t>(condition) << 31));
}

/// Elementary functions for all values that influence a path. The C library chooses its code by CPU, so the same call
/// may round differently on two machines (docs/design/architecture.md, "same bits"); polynomials in plain float
/// operations do not.

/// The smallest normal float. As a lower bound of a divisor it avoids 0/0 without a branch, where the numerator is 0
/// whenever the divisor is.
inline constexpr float kLeastNormal = 0x1p-126f;

/// Power 2^exponent for exponents of -126 to 127.
inline float power_of_two(int exponent) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(127 + exponent) << 23);
}

/// Power 2^exponent for exponents of -1022 to 1023; scaling a float by it is exact.
inline double exact_power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

/// Sine and cosine of x in [0, pi/2], error below 2e-7.
struct SinCos {
    float sin, cos;
};

inline SinCos sincos_quadrant(float x) {
    constexpr float kHalfPi = 1.57079632679489661923f;
    const bool fold = x > 0.5f * kHalfPi;  // evaluated on [0, pi/4] only
    const float t = select(fold, kHalfPi - x, x);
    const float t2 = t * t;
    const float s =
        t * (1.0f + t2 * (-1.6666667e-1f + t2 * (8.3333310e-3f + t2 * (-1.9840874e-4f + t2 * 2.7525562e-6f))));
    const float c = 1.0f + t2 * (-0.5f + t2 * (4.1666668e-2f + t2 * (-1.3888887e-3f + t2 * 2.4801587e-5f)));
    return {select(fold, c, s), select(fold, s, c)};
}

/// Sine and cosine of 2 pi u for u in [0, 1].
inline SinCos sincos_turn(float u) {
    const float quarter = u * 4.0f;
    const int quadrant = static_cast<int>(quarter);
    const SinCos r = sincos_quadrant((quarter - static_cast<float>(quadrant)) * 1.57079632679489661923f);
    const bool odd = quadrant & 1;
    return {negate_if(quadrant & 2, select(odd, r.cos, r.sin)),
            negate_if((quadrant + 1) & 2, select(odd, r.sin, r.cos))};
}

/// Arc tangent atan(x) * 2/pi for x in [0, 1], error below 3e-8 (minimax fit).
inline float atan_quadrant(float x) {
    const float x2 = x * x;
    return x * (0.63661935f +
                x2 * (-0.21218451f +
                      x2 * (0.126984059f +
                            x2 * (-0.0885464073f +
                                  x2 * (0.0613873596f +
                                        x2 * (-0.0355991094f + x2 * (0.0139211997f + x2 * -0.002581966f)))))));
}

/// Angle of (x, y) from the x axis, over 2 pi, in [0, 1); 0 for (0, 0). Error below 1e-7.
inline float azimuth_turn(float x, float y) {
    const float ax = std::abs(x), ay = std::abs(y);
    const bool steep = !(ax > ay);
    const float large = select(steep, ay, ax), small = select(steep, ax, ay);
    if (!(large > 0.0f)) return 0.0f;
    float turn = 0.25f * atan_quadrant(small / large);
    turn = select(ay > ax, 0.25f - turn, turn);
    turn = select(x < 0.0f, 0.5f - turn, turn);
    turn = select(y < 0.0f, 1.0f - turn, turn);
    return turn < 1.0f ? turn : 0.0f;
}

/// Arc cosine acos(x) / pi for x clamped to [-1, 1], without the cancellation of `1 - x` near the ends.
inline float acos_half_turn(float x) {
    if (!(x > -1.0f)) return 1.0f;
    if (!(x < 1.0f)) return 0.0f;
    return 2.0f * azimuth_turn(x, std::sqrt((1.0f - x) * (1.0f + x)));
}

}  // namespace treefarm
