// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "common/scene/model/scene.h"

namespace treefarm::linting {

// Where a few hundred rays that look at a scene start and go.

/// A low-discrepancy point of the unit square (Roberts 2018), the same every time.
std::array<double, 2> point_of_square(int i);

/// A direction of all.
Imath::V3d direction_of_sphere(double u, double v);

/// A direction about the axis, cosine-distributed.
Imath::V3d direction_of_hemisphere(const Imath::V3d& axis, double u, double v);

/// A direction within a cone.
Imath::V3d direction_of_cone(const LightCone& cone, double u, double v);

/// A point of a surface with its normal.
using SurfacePoint = std::pair<Imath::V3d, Imath::V3d>;

/// Number i of a shape's points, drawn by (u, v) of the unit square; nothing where it has none of its own.
std::optional<SurfacePoint> point_on(const Shape& shape, int i, double u, double v);

/// Whether everything that rays need exists and is finite, and there is not too much of it.
bool can_be_looked_at(const Scene& scene);

}  // namespace treefarm::linting
