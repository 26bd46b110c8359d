// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/scene/kinds/traits/texture_traits.h"

namespace treefarm {

/// Attribute of the mesh on which the texture is looked up: of vertices, interpolated over triangles, or of faces.
struct MeshAttributeTexture {
    std::string name = "vertex_color";  ///< as in MeshAttribute

    static constexpr KindEffect kEffect{"mesh_attributes", "mesh attribute"};
    ValueRange range(const auto& scene) const { return scene.range_of_attribute(name); }
    Rgb mean(const auto& scene) const { return scene.mean_of_attribute(name); }
    static void fields(auto& self, auto& visitor) { visitor.mesh_attribute(self.name); }
};

}  // namespace treefarm
