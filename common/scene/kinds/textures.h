// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "common/scene/kinds/fields.h"
#include "common/scene/kinds/textures/bitmap.h"
#include "common/scene/kinds/textures/checkerboard.h"
#include "common/scene/kinds/textures/grid.h"
#include "common/scene/kinds/textures/mesh_attribute.h"
#include "common/scene/kinds/textures/wireframe.h"

namespace treefarm {

/// All kinds of textures. The index of a kind is its number in packed form: new kinds come last. Each kind has
/// fields(), and its range and mean, given a scene that knows those of images and mesh attributes (range_of_image,
/// range_of_attribute, mean_of_image, mean_of_attribute).
using TextureKind =
    std::variant<BitmapTexture, CheckerboardTexture, MeshAttributeTexture, GridTexture, WireframeTexture>;

}  // namespace treefarm
