// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "worker/lights/light_lanes.h"

namespace treefarm {

/// Units of the light tree, in which emitters are within about 1 of the origin and their amounts sum to 1: no scale of
/// a scene brings a float near its limits, and scaling by powers of two changes no bit of a choice.
class LightSpace {
  public:
    LightSpace() = default;
    /// Units for these emitters. Throws RunError if a position is undefined, or an amount is negative or not finite.
    explicit LightSpace(std::span<const LightBounds> bounds);

    Vec3 normalised(const Vec3& p) const { return (p - origin_) * scale_; }
    void set(LightLanes& lanes, int lane, const LightBounds& bounds) const {
        lanes.set(lane, bounds, Imath::V3d(origin_), double(scale_), per_amount_);
    }

  private:
    Vec3 origin_{0.0f};
    float scale_ = 1.0f;  ///< a power of two
    double per_amount_ = 1.0;
};

}  // namespace treefarm
