// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/light_lanes.h"

namespace treefarm {
namespace {

/// Widening of cones in half turns (1e-4 radians), so that rounding does not darken their rims.
constexpr float kRim = 3.2e-5f;

SinCos sincos_half_turns(float half_turns) {
    return sincos_turn(0.5f * std::min(half_turns + kRim, 1.0f));
}

}  // namespace

void LightLanes::set(int lane, const LightBounds& bounds, const Imath::V3d& origin, double scale, double per_amount) {
    const auto k = static_cast<std::size_t>(lane);
    const SinCos cone = sincos_half_turns(bounds.cone.half_turns);
    axis_x[k] = bounds.cone.axis.x;
    axis_y[k] = bounds.cone.axis.y;
    axis_z[k] = bounds.cone.axis.z;
    cone_cos[k] = cone.cos;
    cone_sin[k] = cone.sin;
    falloff_cos[k] = sincos_half_turns(bounds.falloff).cos;
    radius2[k] = -1.0f;
    amount[k] = static_cast<float>(bounds.amount * per_amount);
    if (bounds.at_infinity) return;
    const Imath::V3d center = (Imath::V3d(bounds.box.min) + Imath::V3d(bounds.box.max)) * 0.5 - origin;
    const double radius = double(bounds.radius) * scale;
    x[k] = static_cast<float>(center.x * scale);
    y[k] = static_cast<float>(center.y * scale);
    z[k] = static_cast<float>(center.z * scale);
    radius2[k] = static_cast<float>(radius * radius);
    amount[k] = static_cast<float>(bounds.amount * scale * scale * per_amount);
}

}  // namespace treefarm
