// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/light_space.h"

#include <cmath>

#include "common/base/error.h"

namespace treefarm {

LightSpace::LightSpace(std::span<const LightBounds> bounds) {
    Box3 box;
    for (const LightBounds& b : bounds) {
        const bool placed = b.at_infinity || (is_finite(b.box.min) && is_finite(b.box.max) && std::isfinite(b.radius));
        if (!placed || !is_finite(b.cone.axis) || !(b.amount >= 0.0 && b.amount < 1e300))
            throw RunError("an emitter's position or power is no finite number");
        if (!b.at_infinity) box.extendBy(b.box);
    }
    if (!box.isEmpty()) {
        const Imath::V3d low(box.min), high(box.max);
        const Imath::V3d size = high - low;
        origin_ = Vec3((low + high) * 0.5);
        int exponent = 0;
        std::frexp(std::max(size.x, std::max(size.y, size.z)), &exponent);
        scale_ = power_of_two(std::clamp(-exponent, -120, 120));
    }
    double total = 0;
    for (const LightBounds& b : bounds)
        total += b.amount * (b.at_infinity ? 1.0 : double(scale_) * double(scale_));
    if (total > 0) per_amount_ = 1.0 / total;
}

}  // namespace treefarm
