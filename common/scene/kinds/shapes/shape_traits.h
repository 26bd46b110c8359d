// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/math/vec.h"
#include "common/scene/kinds/traits/texture_image.h"

namespace treefarm {

/// Whether two unit vectors are at right angles, within the rounding of readers. False for vectors that are not finite.
inline bool at_right_angles(const Vec3& a, const Vec3& b) {
    return std::abs(dot(a, b)) <= 1e-3f;
}

/// Half the extent along each axis of an ellipse with these half axes.
inline Vec3 ellipse_extent(const Vec3& u, const Vec3& v) {
    Vec3 extent;
    for (int i = 0; i < 3; ++i)
        extent[i] = std::sqrt(u[i] * u[i] + v[i] * v[i]);
    return extent;
}

/// Box around `center` with half the size `extent`.
inline Box3 box_about(const Vec3& center, const Vec3& extent) {
    Box3 box;
    box.extendBy(center - extent);
    box.extendBy(center + extent);
    return box;
}

}  // namespace treefarm
