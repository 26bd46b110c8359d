// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.h"
#include "common/scene/model/shape.h"

namespace treefarm::packed {

///     shape    := kind:u8 value* material:i32 emitter:i32 group:i32 name
///
/// kind: index in ShapeKind (kinds/shapes.h), or kMeshWithAttributes (shape_codec.cpp); values: in the order of the
/// kind's fields(). Lists of a mesh are a count and the bytes of the elements; attributes, each a name and a list, are
/// present if there are any; a transform is the first three columns of its rows, since the fourth is 0 0 0 1.

inline constexpr std::size_t kMinShapeBytes = 18;

/// Throws FormatError if an instance's transform is not affine: it has no packed form.
void put_shape(ByteWriter& out, const Shape& shape);

/// A shape; `Shape::emitter` is not checked, since emitters come later.
Shape get_shape(ByteReader& in, std::size_t material_count, std::size_t group_count);

}  // namespace treefarm::packed
