// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/material.h"

namespace treefarm::packed {

///     material  := kind:u8 (diffuse | conductor | dielectric | thin | plastic | blend | null)
///                  twosided:u8 back:i32 opacity:number bump:i32 bump_scale:f32 normal_map:i32
///                  normal_scale:rgb flip_invalid:u8 shadowed:u8 name location
///     diffuse   := color
///     conductor := eta:rgb k:rgb color roughness
///     dielectric := eta:f32 color color roughness
///     thin      := eta:f32 color color
///     plastic   := eta:f32 color color nonlinear:u8 roughness single_return:u8
///     blend     := number first:i32 second:i32
///     null      :=
///     roughness := distribution:u8 number number
///     color     := rgb texture:i32
///     number    := f32 texture:i32

inline constexpr std::size_t kMinMaterialBytes = 36;

void put_material(ByteWriter& out, const Material& material);

/// `index` is the material's own: those that it refers to stand before it.
Material get_material(ByteReader& in, std::size_t index, std::size_t texture_count);

}  // namespace treefarm::packed
