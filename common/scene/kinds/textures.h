// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "common/scene/kinds/fields.h"
#include "common/scene/kinds/textures/bitmap.h"
#include "common/scene/kinds/textures/checkerboard.h"
#include "common/scene/kinds/textures/mesh_attribute.h"

namespace treefarm {

/// Every kind of texture. Its place here is its number in packed form: new ones come last. Beside its fields() each
/// says, of a scene that knows range and mean of an image and of an attribute of its meshes (range_of_image,
/// range_of_attribute, mean_of_image, mean_of_attribute), its own range and mean.
using TextureKind = std::variant<BitmapTexture, CheckerboardTexture, MeshAttributeTexture>;

}  // namespace treefarm
