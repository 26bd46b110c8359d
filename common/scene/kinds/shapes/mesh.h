// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/scene/kinds/shapes/shape_traits.h"

namespace treefarm {

/// Values at each vertex or triangle for textures: "vertex_color", "face_color", "vertex_wear"...
struct MeshAttribute {
    std::string name;         ///< begins with "face_" for values of triangles
    std::vector<Rgb> values;  ///< linear; one per position, or per triangle; numbers are grey

    static bool is_of_faces(const std::string& name) { return name.starts_with("face_"); }
    bool is_of_faces() const { return is_of_faces(name); }
};

/// An indexed triangle mesh in world space (or its group's space).
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;              ///< unit shading normals, one per position; empty: geometric normals
    std::vector<Vec2> uvs;                  ///< one per position; empty: none
    std::vector<std::uint32_t> indices;     ///< three per triangle, counter-clockwise seen from the front
    std::vector<MeshAttribute> attributes;  ///< after validate_scene(), only those that a texture needs

    /// Adds an attribute without values.
    MeshAttribute& add_attribute(const std::string& name) {
        attributes.push_back({name, {}});
        return attributes.back();
    }

    std::size_t triangle_count() const { return indices.size() / 3; }
    /// The attribute of this name, or nullptr.
    const MeshAttribute* find_attribute(const std::string& name) const {
        for (const MeshAttribute& attribute : attributes)
            if (attribute.name == name) return &attribute;
        return nullptr;
    }

    Box3 box() const {
        Box3 box;
        for (const Vec3& position : positions)
            box.extendBy(position);
        return box;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.vertices(self.positions);
        visitor.per_vertex("normal", self.normals);
        visitor.per_vertex("texture coordinate", self.uvs);
        visitor.triangles(self.indices);
        visitor.attributes(self.attributes);
    }
};

}  // namespace treefarm
