// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "common/math/vec.h"

namespace treefarm {

/// A half line, or a segment up to `length` times the direction.
struct Ray {
    Vec3 origin;
    Vec3 direction;  ///< need not be unit
    float length = std::numeric_limits<float>::infinity();
    bool of_camera = false;  ///< meets the camera: passes hidden emitters (ShapeMasks::hidden)
};

}  // namespace treefarm
