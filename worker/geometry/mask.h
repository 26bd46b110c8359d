// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/model/shape.h"
#include "worker/textures/texture_set.h"

struct RTCGeometryTy;

namespace treefarm {

/// Mask of a shape that lets some rays pass, or those of the camera.
///
/// An opacity other than 0 and 1 is decided by a hash of the ray and the hit, so that the answer is a pure function of
/// both: equal in every traversal order and in intersect and occluded alike, without state that travels with the ray.
/// Different rays, and different layers met by one ray, are decided independently.
struct Mask {
    std::uint32_t shape_index = 0;
    const Shape* shape = nullptr;
    FloatInput opacity{1.0f};
    const TextureSet* textures = nullptr;  ///< not null if the opacity varies
    bool hidden = false;                   ///< camera rays pass

    /// Whether the opacity lets any ray pass.
    bool lets_pass() const { return opacity.varies() || opacity.value < 1.0f; }
    /// Opacity at a point, in [0, 1] (NaN counts as 1). Arguments as for shape_uv().
    float opacity_at(std::uint32_t primitive, float b1, float b2, const Vec3& outward) const;

    /// Whether the ray meets the shape at the hit. `ray` and `hit` are Embree's RTCRay and RTCHit; `b1` and `b2` are
    /// taken from the hit, `outward` is its Ng.
    bool accepts(const void* ray, const void* hit) const;
};

/// Installs the mask as Embree's filter of hits with a mesh. The mask must outlive the geometry.
void set_mask_filter(RTCGeometryTy* geometry, const Mask& mask);

}  // namespace treefarm
