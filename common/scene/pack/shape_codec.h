// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/model/shape.h"

namespace treefarm::packed {

///     shape    := kind:u8 (mesh | sphere | disk | cylinder | instance) material:i32 emitter:i32 group:i32 name
///     location mesh     := positions normals uvs indices        each a count and its elements sphere   := center
///     radius:f32 flip:u8 pole meridian disk     := center half_u half_v mirrored:u8 cylinder := p0 p1 radius:f32
///     flip:u8 meridian mirrored:u8 instance := group:i32 to_world:f32[12]           the rows' first three columns; the
///     fourth is 0 0 0
///     1

inline constexpr std::size_t kMinShapeBytes = 27;

/// FormatError if an instance's transform is not affine: it has no packed form.
void put_shape(ByteWriter& out, const Shape& shape);

/// `Shape::emitter` is not checked: emitters come later.
Shape get_shape(ByteReader& in, std::size_t material_count, std::size_t group_count);

}  // namespace treefarm::packed
