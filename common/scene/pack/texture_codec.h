// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/model/texture.h"

namespace treefarm::packed {

///     image    := width:u16 height:u16 channels:u8 floating:u8 (decode:f32[256] bytes | floats)
///     texture  := kind:u8 value* name
///
/// kind: index in TextureKind (kinds/textures.h); values: in the order of the kind's fields(), indices as i32, flags
/// and choices as u8, colours as three f32, the transform of coordinates as its two rows.

inline constexpr std::size_t kMinImageBytes = 7, kMinTextureBytes = 3;

void put_image(ByteWriter& out, const TextureImage& image);
TextureImage get_image(ByteReader& in);
void put_texture(ByteWriter& out, const Texture& texture);
Texture get_texture(ByteReader& in, std::size_t image_count);

}  // namespace treefarm::packed
