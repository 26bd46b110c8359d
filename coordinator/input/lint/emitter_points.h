// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "common/scene/model/scene.h"

namespace treefarm::linting {

// Origins and directions of a few hundred rays that examine a scene.

/// Point i of a low-discrepancy sequence in the unit square (Roberts 2018); deterministic.
std::array<double, 2> point_of_square(int i);

/// Uniform direction of the sphere.
Imath::V3d direction_of_sphere(double u, double v);

/// Direction around the axis, cosine-distributed.
Imath::V3d direction_of_hemisphere(const Imath::V3d& axis, double u, double v);

/// Uniform direction within a cone.
Imath::V3d direction_of_cone(const LightCone& cone, double u, double v);

/// Origin and unit direction of the camera ray through a point of the film, in [0, 1]^2 of its window.
std::pair<Imath::V3d, Imath::V3d> camera_ray(const Scene& scene, double u, double v);

/// A point of a surface with its normal.
using SurfacePoint = std::pair<Imath::V3d, Imath::V3d>;

/// Point number i of a shape, from (u, v) in the unit square; empty if the shape has no surface of its own.
std::optional<SurfacePoint> point_on(const Shape& shape, int i, double u, double v);

/// Whether all data that rays need exist and are finite, and are not too many.
bool can_be_looked_at(const Scene& scene);

}  // namespace treefarm::linting
