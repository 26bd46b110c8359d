// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

struct RTCGeometryTy;

namespace treefarm {

struct Shape;
struct Mask;

/// Number that stands for the instance in a hit with a sphere, disk or cylinder of the world: one comparison then tells
/// plain triangles from everything else.
inline constexpr std::uint32_t kWorldUserShape = 0xfffffffeu;

/// Makes an Embree user geometry answer for a sphere, disk or cylinder; with a mask it meets some rays only. Shape and
/// mask (nullptr: none) must outlive the geometry.
void set_user_callbacks(RTCGeometryTy* geometry, const Shape& shape, const Mask* mask);

}  // namespace treefarm
