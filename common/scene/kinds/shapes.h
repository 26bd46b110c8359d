// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "common/scene/kinds/fields.h"
#include "common/scene/kinds/shapes/cylinder.h"
#include "common/scene/kinds/shapes/disk.h"
#include "common/scene/kinds/shapes/instance.h"
#include "common/scene/kinds/shapes/mesh.h"
#include "common/scene/kinds/shapes/sphere.h"

namespace treefarm {

/// All kinds of shapes. The index of a kind decides its number in packed form (pack/shape_codec.h): new kinds come
/// last. Each kind has fields() and the box of its own surface, in its group's space.
using ShapeKind = std::variant<Mesh, Sphere, Disk, Cylinder, Instance>;

}  // namespace treefarm
