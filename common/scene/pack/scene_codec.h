// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/base/bytes.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// The packed form of a scene, as sent to workers.
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
/// scene has exactly one byte form, so equal scenes have equal bytes.
Bytes encode_scene(const Scene& scene);

/// Hash of everything in a packed scene that influences the image: all but the origins of its parts. It does not change
/// if the scene moves to another folder, or its file gets another line. `packed`: by encode_scene().
std::uint64_t content_hash(std::span<const std::uint8_t> packed);

/// Reads a scene written by encode_scene(). Every count is checked against the remaining bytes and every index against
/// its target, so the result can be walked without further checks. Throws FormatError. Whether values make sense is
/// checked by validate_scene(), on the coordinator.
Scene decode_scene(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
