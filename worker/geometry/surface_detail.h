// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"

namespace treefarm {

/// Texture coordinates of a surface point, and the surface's tangents there.
struct SurfaceDetail {
    Vec2 uv{0.0f};
    Vec3 dp_du{0.0f}, dp_dv{0.0f};  ///< never zero or parallel: a frame around the normal where uv are degenerate
};

/// Texture coordinates of a point of any shape but an instance (conventions: common/scene/model/shape.h). `b1`, `b2` as
/// in Hit; `outward`: unit vector away from the centre of a sphere or the axis of a cylinder, in the shape's own space;
/// unused by other shapes.
Vec2 shape_uv(const Shape& shape, std::uint32_t primitive, float b1, float b2, const Vec3& outward);

/// Texture coordinates of a point, with tangents in the shape's own space; arguments as for shape_uv().
SurfaceDetail shape_detail(const Shape& shape, std::uint32_t primitive, float b1, float b2, const Vec3& outward);

}  // namespace treefarm
