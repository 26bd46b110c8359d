// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"

namespace treefarm {

/// Where on its texture a surface point lies, and how the surface runs there.
struct SurfaceDetail {
    Vec2 uv{0.0f};
    Vec3 dp_du{0.0f}, dp_dv{0.0f};  ///< never zero or parallel: a frame around the normal where uv are degenerate
};

/// The uv of a point of any shape but an instance (conventions: common/scene/model/shape.h). `b1`, `b2` as in Hit;
/// `outward`: unit vector away from the centre of a sphere or the axis of a cylinder, in the shape's own space; else
/// unused.
Vec2 shape_uv(const Shape& shape, std::uint32_t primitive, float b1, float b2, const Vec3& outward);

/// The uv of a point, with tangents in the shape's own space; arguments as for shape_uv().
SurfaceDetail shape_detail(const Shape& shape, std::uint32_t primitive, float b1, float b2, const Vec3& outward);

}  // namespace treefarm
