#pragma once

#include <cstdint>
#include <span>

#include "common/base/bytes.h"
#include "common/scene/scene.h"

namespace treefarm {

/// The packed form in which the scene travels to workers.
///
///     scene    := magic:u32 version:u32 materials shapes emitters camera film
///     material := kind:u8 rgb twosided:u8 name location
///     shape    := kind:u8 (mesh | sphere) material:i32 emitter:i32 name location
///     mesh     := positions normals uvs indices        each a count and its elements
///     sphere   := center radius:f32 flip:u8
///     emitter  := kind:u8 rgb shape:i32 location       (area: the shape; constant: none)
///     camera   := origin corner across down
///     film     := width:i32 height:i32 filter:u8 radius:f32 stddev:f32
///     location := file:string line:i32 column:i32
///
/// Lists are a varint count and the elements; a scene has exactly one byte form, so equal scenes have equal bytes.
Bytes encode_scene(const Scene& scene);

/// Reads what encode_scene wrote. Every count is checked against what remains and every index against what it points
/// into; anything wrong throws FormatError.
Scene decode_scene(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
