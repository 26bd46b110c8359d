#pragma once

#include "common/math/frame.h"
#include "common/math/warp.h"
#include "common/scene/scene.h"

namespace treefarm {

/// The cone of directions in which a sphere is seen from a point outside of it.
struct SphereCone {
    bool outside = false;     ///< false: the point is inside or on the sphere, there is no cone
    Vec3 axis{0.0f};          ///< unit, towards the centre
    float sin2_max = 0;       ///< squared sine of the half angle
    float one_minus_cos = 0;  ///< 1 - cos of the half angle, without the cancellation that small cones suffer

    float pdf() const { return 0.5f * kInvPi / one_minus_cos; }
};

inline SphereCone sphere_cone(const Sphere& sphere, const Vec3& from) {
    SphereCone cone;
    const Vec3 to_center = sphere.center - from;
    const float distance2 = dot(to_center, to_center), radius2 = sphere.radius * sphere.radius;
    if (!(distance2 > 1.0001f * radius2)) return cone;
    cone.axis = to_center * (1.0f / std::sqrt(distance2));
    cone.sin2_max = radius2 / distance2;
    cone.one_minus_cos = cone.sin2_max / (1.0f + std::sqrt(1.0f - cone.sin2_max));
    cone.outside = cone.one_minus_cos > 0.0f;
    return cone;
}

/// A direction of the cone, uniform, and the outward normal of the sphere where it is met first.
struct ConeSample {
    Vec3 direction;
    Vec3 normal;
};

/// The angle alpha at the centre follows from the angle theta at the point by the law of sines (Pharr, Jakob and
/// Humphreys, "Physically Based Rendering", 4th ed., section 6.2.4).
inline ConeSample sample_cone(const SphereCone& cone, const Vec2& u) {
    const Vec3 w = square_to_cone(u, cone.one_minus_cos);
    const float h = u.x * cone.one_minus_cos;
    const float sin2_theta = h * (2.0f - h);
    const float ratio2 = std::min(1.0f, sin2_theta / cone.sin2_max);  // (sin theta / sin theta_max)^2
    const float sin_max = std::sqrt(cone.sin2_max);
    const float cos_alpha = ratio2 * sin_max + (1.0f - h) * std::sqrt(1.0f - ratio2);
    const float sin_alpha = std::sqrt(std::max(0.0f, 1.0f - cos_alpha * cos_alpha));
    const float sin_theta = std::sqrt(w.x * w.x + w.y * w.y);
    const float along = sin_theta > 0.0f ? sin_alpha / sin_theta : 0.0f;
    const Frame frame(cone.axis);
    return {frame.to_world(w), frame.to_world(Vec3(w.x * along, w.y * along, -cos_alpha))};
}

}  // namespace treefarm
