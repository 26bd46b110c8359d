// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/base/bytes.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// The packed form in which the scene travels to workers.
///
///     scene    := content origins size_of_content:u64
///     content  := magic:u32 version:u32 images textures materials groups:u32 shapes emitters camera film
///     camera   := origin corner across down lens_u lens_v
///     film     := width:i32 height:i32 filter:u8 radius:f32 stddev:f32
///     origins  := file:string of each image, location of each texture, material, shape and emitter
///     location := file:string line:i32 column:i32
///
/// Images and textures are in texture_codec.h, materials in material_codec.h, shapes in shape_codec.h, emitters in
/// emitter_codec.h. Lists are a varint count and the elements; vectors are their components in single precision. A
/// scene has exactly one byte form, and the bytes of equal scenes are equal.
Bytes encode_scene(const Scene& scene);

/// A hash of what a packed scene renders to: of all but where its parts stand. A scene that was moved to another
/// folder, or whose file got a line more, keeps it. `packed`: by encode_scene.
std::uint64_t content_hash(std::span<const std::uint8_t> packed);

/// Reads what encode_scene wrote. Every count is checked against what remains and every index against what it points
/// into, so that a scene which was read can be walked without further checks; anything wrong throws FormatError.
/// Whether the numbers make sense is validate_scene's affair, on the coordinator.
Scene decode_scene(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
