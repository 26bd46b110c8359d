// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/frame.h"
#include "common/math/warp.h"
#include "worker/lights/area_measure.h"
#include "worker/lights/sphere_cone.h"

namespace treefarm {

/// A sampled point on a sphere, as seen from a point.
struct SphereSample {
    Vec3 direction;  ///< unit, towards the sampled point
    Vec3 normal;     ///< unit, outward
    Vec3 p;          ///< the sampled point
    float distance;
    float pdf;  ///< per steradian; 0: no sample
};

// Without a branch, so that loops over these functions become vector code (sphere_batch.h).

/// Direction distributed uniformly in the sphere's cone, from outside, and its first intersection with the sphere. The
/// angle alpha at the centre follows from the angle theta at the point by the law of sines (Pharr, Jakob and Humphreys,
/// "Physically Based Rendering", 4th ed., section 6.2.4).
inline SphereSample sample_by_cone(const Vec3& center, float radius, const Vec3& from, const Vec2& u) {
    const SphereCone cone = cone_from_outside(center - from, radius);
    const Vec3 w = square_to_cone(u, cone.one_minus_cos);
    const float h = u.x * cone.one_minus_cos;
    const float sin2_theta = h * (2.0f - h);
    const float ratio2 = std::min(1.0f, sin2_theta / cone.sin2_max);  // (sin theta / sin theta_max)^2
    const float sin_max = std::sqrt(cone.sin2_max);
    const float cos_alpha = ratio2 * sin_max + (1.0f - h) * std::sqrt(1.0f - ratio2);
    const float sin_alpha = std::sqrt(std::max(0.0f, 1.0f - cos_alpha * cos_alpha));
    const float sin_theta = std::sqrt(w.x * w.x + w.y * w.y);
    const bool aside = sin_theta > 0.0f;
    const float along = select(aside, sin_alpha / select(aside, sin_theta, 1.0f), 0.0f);
    const Frame frame(cone.axis);
    const Vec3 normal = normalize(frame.to_world(Vec3(w.x * along, w.y * along, -cos_alpha)));
    const Vec3 p = center + normal * radius, to_p = p - from;
    return {frame.to_world(w), normal, p, std::sqrt(dot(to_p, to_p)), cone.pdf()};
}

/// Point distributed uniformly by area, seen from inside or outside.
inline SphereSample sample_by_area(const Vec3& center, float radius, const Vec3& from, const Vec2& u) {
    const Vec3 normal = normalize(square_to_sphere(u));
    const Vec3 p = center + normal * radius, to_p = p - from;
    const float distance2 = dot(to_p, to_p);
    const bool away = distance2 > 0.0f;
    const float distance = std::sqrt(distance2);
    const Vec3 direction = to_p * (1.0f / select(away, distance, 1.0f));
    const float pdf = per_steradian(sphere_area_density(radius), distance2, std::abs(dot(normal, direction)));
    return {direction, normal, p, distance, select(away, pdf, 0.0f)};
}

}  // namespace treefarm
