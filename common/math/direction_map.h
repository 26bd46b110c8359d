// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/math/elementary.h"
#include "common/math/vec.h"

namespace treefarm {

/// The equal-area octahedral map from unit directions to the unit square (Clarberg 2008, "Fast equal-area mapping of
/// the (hemi)sphere using SIMD"). A density p on the square is p / (4 pi) per steradian. It takes half the time of the
/// cylindrical map of the authors' program and has no stretched poles.
inline Vec2 direction_to_square(const Vec3& d) {
    const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
    const float r =
        std::sqrt((ax * ax + ay * ay) / (1.0f + az));  // equals sqrt(1 - |z|), without cancellation near the poles
    const float high = std::max(ax, ay), low = std::min(ax, ay);
    // Angle from the x axis; 0..1 stands for 0..90 degrees.
    float phi = atan_quadrant(low / std::max(high, kLeastNormal));
    phi = select(ay > ax, 1.0f - phi, phi);
    const float along = phi * r, across = r - along;
    const bool below = d.z < 0.0f;
    const float u = std::copysign(select(below, 1.0f - along, across), d.x);
    const float v = std::copysign(select(below, 1.0f - across, along), d.y);
    constexpr float kBelowOne = 0x1.fffffep-1f;
    return {std::clamp(0.5f * (u + 1.0f), 0.0f, kBelowOne), std::clamp(0.5f * (v + 1.0f), 0.0f, kBelowOne)};
}

/// Inverse of direction_to_square; x and y in [0, 1].
inline Vec3 square_to_direction(const Vec2& p) {
    const float u = 2.0f * p.x - 1.0f, v = 2.0f * p.y - 1.0f;
    const float au = std::abs(u), av = std::abs(v);
    const float signed_distance = 1.0f - (au + av);
    const float distance = std::abs(signed_distance);
    const float r = 1.0f - distance;
    const float phi =
        ((av - au) / std::max(r, kLeastNormal) + 1.0f) * (0.5f * kPi * 0.5f);  // any value will do at the pole
    const float z = std::copysign(1.0f - r * r, signed_distance);
    const SinCos a = sincos_quadrant(std::clamp(phi, 0.0f, 0.5f * kPi));
    const float sin_theta = r * std::sqrt(std::max(0.0f, 2.0f - r * r));
    return {std::copysign(a.cos * sin_theta, u), std::copysign(a.sin * sin_theta, v), z};
}

/// Bits per coordinate of a direction code: the unit square in 2^16 x 2^16 steps along the Z-order curve. A quadtree
/// cell of depth d is an aligned range of 4^(16-d) codes.
inline constexpr int kDirectionBits = 16;

inline std::uint32_t spread_bits(std::uint32_t v) {
    v = (v | (v << 8)) & 0x00ff00ffu;
    v = (v | (v << 4)) & 0x0f0f0f0fu;
    v = (v | (v << 2)) & 0x33333333u;
    return (v | (v << 1)) & 0x55555555u;
}

inline std::uint32_t compact_bits(std::uint32_t v) {
    v &= 0x55555555u;
    v = (v | (v >> 1)) & 0x33333333u;
    v = (v | (v >> 2)) & 0x0f0f0f0fu;
    v = (v | (v >> 4)) & 0x00ff00ffu;
    return (v | (v >> 8)) & 0x0000ffffu;
}

/// Z-order code of a point of the unit square (coordinates in [0, 1)).
inline std::uint32_t square_to_code(const Vec2& p) {
    const auto step = [](float t) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(t * 65536.0f)); };
    return spread_bits(step(p.x)) | (spread_bits(step(p.y)) << 1);
}

inline std::uint32_t direction_to_code(const Vec3& d) {
    return square_to_code(direction_to_square(d));
}

}  // namespace treefarm
