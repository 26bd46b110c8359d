// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "common/math/vec.h"

namespace treefarm {

/// Matrix from linear Rec. 709 to CIE XYZ relative to white, and its inverse: from the primaries of ITU-R BT.709 and
/// the white point D65, (x, y) = (0.31271, 0.32902). Rows sum to 1.
inline constexpr float kRgbToXyz[3][3] = {{0.433895388832f, 0.376242372622f, 0.189862238546f},
                                          {0.212636821677f, 0.715182981841f, 0.072180196481f},
                                          {0.017752423152f, 0.109465628662f, 0.872781948186f}};
inline constexpr float kXyzToRgb[3][3] = {{3.080341988280f, -1.537398969489f, -0.542943018792f},
                                          {-0.921178396165f, 1.875929983695f, 0.045248412470f},
                                          {0.052881292876f, -0.204011206124f, 1.151129913248f}};

inline Vec3 transform(const float (&m)[3][3], const Vec3& v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/// Opponent colours YCxCz (Flohr et al. 1993): CIELAB without its cube root, hence linear in light. Y is 100 at white
/// and -16 at black; Cx is red against green, Cz yellow against blue.
inline Vec3 rgb_to_opponent(const Vec3& rgb) {
    const Vec3 xyz = transform(kRgbToXyz, rgb);
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

inline Vec3 opponent_to_rgb(const Vec3& opponent) {
    const float y = (opponent.x + 16.0f) / 116.0f;
    return transform(kXyzToRgb, {y + opponent.y / 500.0f, y, y - opponent.z / 200.0f});
}

/// Cube root of a normal x > 0, relative error below 3e-7: a guess from a third of the exponent, then two Halley steps,
/// each of which triples the correct digits. The C library's cbrt took a third of FLIP's time.
inline float cube_root(float x) {
    auto y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3 + 0x2a514067u);
    for (int step = 0; step < 2; ++step) {
        const float cube = y * y * y;
        y *= (cube + 2.0f * x) / (2.0f * cube + x);
    }
    return y;
}

/// CIELAB's response: a cube root, linear near black. Domain: t >= 0. Both pieces are computed, so that loops
/// vectorise.
inline float lab_response(float t) {
    constexpr float kDelta = 6.0f / 29.0f, kLinear = kDelta * kDelta * kDelta;
    const float root = cube_root(std::max(t, kLinear)), line = t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    return t > kLinear ? root : line;
}

/// CIELAB of linear colours in [0, 1], with a and b times L / 100, since colours differ less in the dark (Hunt effect).
inline Vec3 rgb_to_hunt_lab(const Vec3& rgb) {
    const Vec3 xyz = transform(kRgbToXyz, rgb);
    const float x = lab_response(xyz.x), y = lab_response(xyz.y), z = lab_response(xyz.z);
    const float lightness = 116.0f * y - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (x - y), 0.01f * lightness * 200.0f * (y - z)};
}

/// HyAB distance for large colour differences (Abasi et al. 2020): city block in lightness, Euclidean in a and b.
inline float hyab_distance(const Vec3& p, const Vec3& q) {
    const Vec3 d = p - q;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

}  // namespace treefarm
