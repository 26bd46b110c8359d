// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"

namespace treefarm {

class Placement;

/// One primitive of a shape in world space, in double: for decisions that must not depend on rounding. `placement`:
/// transform of its instance; nullptr if the shape is in world space itself.

/// Distance of a world-space point from the primitive's surface; a lower bound for ellipses, and for analytic shapes
/// under an instance. A distance above `within` may be returned as infinity.
double distance_from(const Shape& shape, std::uint32_t primitive, const Placement* placement, const Imath::V3d& p,
                     double within);

/// Largest dot(x, normal) over the points x of the primitive.
double highest_along(const Shape& shape, std::uint32_t primitive, const Placement* placement, const Imath::V3d& normal);

}  // namespace treefarm
