// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/light_bounds.h"

#include <algorithm>
#include <cmath>

#include "common/math/elementary.h"

namespace treefarm {
namespace {

/// Measure of emission directions: integral over the cone and its falloff, weighted by the cosine of the angle beyond
/// it.
double direction_measure(float cone, float falloff) {
    const auto turn = [](float half_turns) { return sincos_turn(0.5f * std::min(std::abs(half_turns), 2.0f)); };
    const float end = std::min(cone + falloff, 1.0f);
    const SinCos c = turn(cone);
    const double pi = 3.14159265358979323846, wide = double(turn(cone - 2.0f * end).cos);
    return 2 * pi * (1 - double(c.cos)) +
           0.5 * pi * (2 * pi * double(end - cone) * double(c.sin) - wide + double(c.cos));
}

double area(const Box3& box) {
    const Imath::V3d size = Imath::V3d(box.max) - Imath::V3d(box.min);
    return 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

float half_diagonal(const Box3& box) {
    const Imath::V3d size = Imath::V3d(box.max) - Imath::V3d(box.min);
    return static_cast<float>(0.5 * std::sqrt(size.dot(size)));
}

}  // namespace

float half_turns_between(const Vec3& a, const Vec3& b) {
    // By sine and cosine: small angles keep their digits.
    const Vec3 across = cross(a, b);
    return 2.0f * azimuth_turn(dot(a, b), std::sqrt(dot(across, across)));
}

DirectionCone joined(const DirectionCone& a, const DirectionCone& b) {
    if (b.half_turns > a.half_turns) return joined(b, a);
    if (a.half_turns >= 1.0f) return a;
    const float between = half_turns_between(a.axis, b.axis);
    if (between + b.half_turns <= a.half_turns) return a;
    const float half_turns = 0.5f * (a.half_turns + between + b.half_turns);
    const float along = dot(a.axis, b.axis);
    const Vec3 across = b.axis - a.axis * along;
    const float length2 = dot(across, across);
    // Between nearly opposite axes the cross product is mostly rounding error and gives no axis of rotation.
    if (half_turns >= 1.0f || !(length2 > (along < 0.0f ? 1e-3f : 0.0f))) return {a.axis, 1.0f};
    const SinCos turned = sincos_turn(0.5f * (half_turns - a.half_turns));
    return {normalize(a.axis * turned.cos + across * (turned.sin / std::sqrt(length2))), half_turns};
}

LightBounds LightBounds::in_box(const Box3& box, double amount) {
    LightBounds bounds;
    bounds.amount = amount;
    bounds.box = box;
    bounds.radius = half_diagonal(box);
    return bounds;
}

LightBounds LightBounds::from_infinity(const DirectionCone& cone, double amount) {
    LightBounds bounds;
    bounds.amount = amount;
    bounds.at_infinity = true;
    bounds.cone = cone;
    return bounds;
}

LightBounds joined(const LightBounds& a, const LightBounds& b) {
    LightBounds both = a;
    both.amount += b.amount;
    both.cone = joined(a.cone, b.cone);
    if (both.at_infinity) return both;
    both.box.extendBy(b.box);
    both.radius = half_diagonal(both.box);
    both.falloff = std::max(a.falloff, b.falloff);
    return both;
}

double sampling_cost(const LightBounds& bounds, double least_area) {
    const double extent = bounds.at_infinity ? 1.0 : std::max(area(bounds.box), least_area);
    return bounds.amount * extent * direction_measure(bounds.cone.half_turns, bounds.falloff);
}

}  // namespace treefarm
