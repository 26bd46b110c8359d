// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/math/vec.h"

namespace treefarm {

/// A point on a surface. Position and normals depend on the primitive and the barycentrics alone, not on the ray: a
/// point chosen by a light sampler and the same point hit by a ray have equal bits.
struct Hit {
    std::uint32_t shape = 0;      ///< index in Scene::shapes; under an instance: of the group's member
    std::uint32_t primitive = 0;  ///< triangle of the mesh; 0 for other shapes
    /// Barycentrics of the second and third vertex; disk: coordinates along its half axes; cylinder: b1 along its axis,
    /// 0 to 1.
    float b1 = 0, b2 = 0;
    std::uint32_t instance = 0;  ///< 1 + index of the instance in Scene::shapes; 0: the shape is in world space itself
    Vec3 p{0.0f};
    Vec3 ng{0.0f};    ///< unit geometric normal of the front; on the side of the shading normal if there is one
    Vec3 ns{0.0f};    ///< unit shading normal; ng if the mesh has none, or an unusable one
    float error = 0;  ///< distance along ng at which a ray is guaranteed to leave the surface, in scene units
};

/// Offset that clears a surface whose coordinates are at most `magnitude` in absolute value: 32 half-ulps of it. The
/// rounding of the position (3 half-ulps) and that in Embree's edges, normal and dot products (up to about 24 in the
/// worst corner of a large triangle) stay below it, at any scale of the scene.
inline float offset_bound(float magnitude) {
    return magnitude * 0x1p-19f;
}

/// Origin of a ray from `hit` into `direction`: offset along ng, to the side of the direction. The rounding of this sum
/// is below a sixteenth of the bound.
inline Vec3 offset_origin(const Hit& hit, const Vec3& direction) {
    return hit.p + hit.ng * (dot(hit.ng, direction) < 0.0f ? -hit.error : hit.error);
}

}  // namespace treefarm
