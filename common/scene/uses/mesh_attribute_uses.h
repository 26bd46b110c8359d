// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Name of the mesh attribute that a texture shows; empty for other textures.
std::string attribute_of(const Texture& texture);

/// Per shape: indices of the textures that its material, with parts, and its emitter use. Indices may be out of range.
std::vector<std::set<std::int32_t>> textures_of_shapes(const Scene& scene);

/// Per shape: names of the mesh attributes that its material, with parts, and its emitter need. Indices may be out of
/// range.
std::vector<std::set<std::string>> mesh_attribute_uses(const Scene& scene);

/// Removes mesh attributes that no texture needs.
void remove_unused_attributes(Scene& scene);

}  // namespace treefarm
