// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/model/shape.h"
#include "worker/textures/texture_set.h"

struct RTCGeometryTy;

namespace treefarm {

/// A shape that some rays pass as if it were not there.
///
/// Where the opacity is neither 0 nor 1 a hash of the ray and of the hit decides, so that the answer is a pure function
/// of both: the same in every traversal order, in intersect and occluded alike, without state that travels with the
/// ray. Different rays, and different layers met by one ray, decide independently.
struct Mask {
    std::uint32_t shape_index = 0;
    const Shape* shape = nullptr;
    FloatInput opacity{1.0f};
    const TextureSet* textures = nullptr;  ///< not null if the opacity varies

    /// Opacity at a point, in [0, 1] (NaN counts as 1). Arguments as of shape_uv().
    float opacity_at(std::uint32_t primitive, float b1, float b2, const Vec3& outward) const;

    /// Whether the ray meets the shape there. `ray` and `hit` as Embree has them: RTCRay and RTCHit; `b1` and `b2` are
    /// taken from the hit, `outward` is its Ng.
    bool accepts(const void* ray, const void* hit) const;
};

/// Makes Embree ask the mask about every hit with a mesh. The mask must outlive the geometry.
void set_mask_filter(RTCGeometryTy* geometry, const Mask& mask);

}  // namespace treefarm
