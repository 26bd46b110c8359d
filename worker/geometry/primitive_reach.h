// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"

namespace treefarm {

class Placement;

/// One primitive of a shape as it stands in the world, in double: for what must not be decided by roundings.
/// `placement` is that of its instance, nullptr if it stands in the world itself.

/// Distance of a point of the world from the primitive's surface; a lower bound of it for ellipses, and for analytic
/// shapes under an instance. What is farther than `within` may be infinitely far.
double distance_from(const Shape& shape, std::uint32_t primitive, const Placement* placement, const Imath::V3d& p,
                     double within);

/// The largest dot(x, normal) over the points x of the primitive.
double highest_along(const Shape& shape, std::uint32_t primitive, const Placement* placement, const Imath::V3d& normal);

}  // namespace treefarm
