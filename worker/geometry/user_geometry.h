// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

struct RTCGeometryTy;

namespace treefarm {

struct Shape;
struct Mask;

/// Instance number of a hit with a world-space sphere, disk or cylinder: one comparison then separates plain triangles
/// from everything else.
inline constexpr std::uint32_t kWorldUserShape = 0xfffffffeu;

/// Installs a sphere, disk or cylinder as an Embree user geometry; a mask lets some rays pass. Shape and mask (nullptr:
/// none) must outlive the geometry.
void set_user_callbacks(RTCGeometryTy* geometry, const Shape& shape, const Mask* mask);

}  // namespace treefarm
