// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>

#ifdef __FAST_MATH__
#error "-ffast-math is refused: it reorders sums, so results would no longer be the same bits on every worker"
#endif

namespace treefarm {

using Vec2 = Imath::V2f;
using Vec3 = Imath::V3f;  ///< a point, a direction or a normal; a row vector, as in Imath
using Box3 = Imath::Box3f;
using Rgb = Imath::C3f;  ///< linear Rec. 709 primaries

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInvFourPi = 0.07957747154594766788f;

inline float dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Unit vector along v; v must not be zero (the result would be NaN).
inline Vec3 normalize(const Vec3& v) {
    return v * (1.0f / std::sqrt(dot(v, v)));
}

inline float max_component(const Rgb& c) {
    return std::max(c.x, std::max(c.y, c.z));
}

/// Mean of the channels: the quantity that guides learn from, as in the authors' program (luminance would starve blue
/// light).
inline float average(const Rgb& c) {
    return (c.x + c.y + c.z) * (1.0f / 3.0f);
}

/// Luminance Y of linear Rec. 709 (ITU-R BT.709); all reported variances are variances of Y.
template <class T>
T luminance(const Imath::Color3<T>& c) {
    return T(0.212671) * c.x + T(0.715160) * c.y + T(0.072169) * c.z;
}

inline bool is_black(const Rgb& c) {
    return c.x == 0.0f && c.y == 0.0f && c.z == 0.0f;
}

inline bool is_finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace treefarm
