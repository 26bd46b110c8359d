// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/elementary.h"
#include "common/math/vec.h"

namespace treefarm {

/// Warps from uniform numbers to shapes, each beside its density. tests/statistical/warp_test.cpp checks every pair.

/// Uniform point of the unit disk (Shirley and Chiu 1997: concentric squares). Density 1/pi.
inline Vec2 square_to_disk(const Vec2& u) {
    const float a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
    const bool wide = std::abs(a) > std::abs(b);
    const float r = select(wide, a, b);
    // In [-1, 1]: an angle of at most 45 degrees.
    const float ratio = select(wide, b, a) / select(r == 0.0f, 1.0f, r);
    const SinCos t = sincos_quadrant(std::abs(ratio) * 0.25f * kPi);
    const float s = std::copysign(t.sin, ratio);
    return {r * select(wide, t.cos, s), r * select(wide, s, t.cos)};
}

/// Cosine-distributed direction about +z. Density cos(theta)/pi.
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
    const Vec2 d = square_to_disk(u);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1.0f - d.x * d.x - d.y * d.y))};
}

inline float cosine_hemisphere_pdf(float cos_theta) {
    return std::max(0.0f, cos_theta) * kInvPi;
}

/// Uniform direction. Density 1/(4 pi).
inline Vec3 square_to_sphere(const Vec2& u) {
    const float z = 1.0f - 2.0f * u.x;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const SinCos a = sincos_turn(u.y);
    return {r * a.cos, r * a.sin, z};
}

/// Uniform direction in a cone about +z, given as 1 - cos(half angle), since the cosine of a small cone rounds to 1.
/// Density 1/(2 pi one_minus_cos).
inline Vec3 square_to_cone(const Vec2& u, float one_minus_cos) {
    const float h = u.x * one_minus_cos;  // 1 - cos(theta)
    const float r = std::sqrt(std::max(0.0f, h * (2.0f - h)));
    const SinCos a = sincos_turn(u.y);
    return {r * a.cos, r * a.sin, 1.0f - h};
}

/// Uniform barycentric coordinates (b1, b2) on a triangle; b0 = 1 - b1 - b2. Density 1/area.
inline Vec2 square_to_triangle(const Vec2& u) {
    const float s = std::sqrt(u.x);
    return {1.0f - s, u.y * s};
}

}  // namespace treefarm
