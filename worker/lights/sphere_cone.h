// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Density per steradian of directions distributed uniformly in a cone.
inline float cone_pdf(float one_minus_cos) {
    return 0.5f * kInvPi / one_minus_cos;
}

/// Cone of directions that a sphere subtends at a point outside of it.
struct SphereCone {
    bool outside = false;     ///< false: there is no cone (has_cone())
    Vec3 axis{0.0f};          ///< unit, towards the centre
    float sin2_max = 0;       ///< squared sine of the half angle
    float one_minus_cos = 0;  ///< 1 - cos of the half angle, without the cancellation that small cones suffer

    float pdf() const { return cone_pdf(one_minus_cos); }
};

/// Cone of a sphere whose centre is at `to_center` from the point, which is outside.
inline SphereCone cone_from_outside(const Vec3& to_center, float radius) {
    SphereCone cone;
    const float distance2 = dot(to_center, to_center);
    cone.outside = true;
    cone.axis = to_center * (1.0f / std::sqrt(distance2));
    cone.sin2_max = radius * radius / distance2;
    cone.one_minus_cos = cone.sin2_max / (1.0f + std::sqrt(1.0f - cone.sin2_max));
    return cone;
}

/// Whether a point is far enough outside of a sphere, and near enough, for a numerically valid cone.
inline bool has_cone(const Sphere& sphere, const Vec3& from) {
    const Vec3 to_center = sphere.center - from;
    const float distance2 = dot(to_center, to_center), radius2 = sphere.radius * sphere.radius;
    return distance2 > 1.0001f * radius2 && radius2 > 2e-38f * distance2;
}

inline SphereCone sphere_cone(const Sphere& sphere, const Vec3& from) {
    return has_cone(sphere, from) ? cone_from_outside(sphere.center - from, sphere.radius) : SphereCone{};
}

}  // namespace treefarm
