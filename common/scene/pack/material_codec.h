// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/model/material.h"

namespace treefarm::packed {

///     material  := kind:u8 value* twosided:u8 back:i32 unlimited:u8 opacity:number bump:i32 bump_scale:f32
///                  normal_map:i32 normal_scale:rgb flip_invalid:u8 shadowed:u8 name
///     roughness := distribution:u8 number number
///     color     := rgb texture:i32
///     number    := f32 texture:i32
///
/// kind: index in MaterialKind (kinds/materials.h); values: in the order of the kind's fields().

inline constexpr std::size_t kMinMaterialBytes = 27;

void put_material(ByteWriter& out, const Material& material);

/// A material; `index`: its own, below which the indices of its parts must be.
Material get_material(ByteReader& in, std::size_t index, std::size_t texture_count);

}  // namespace treefarm::packed
