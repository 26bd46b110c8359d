// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "common/base/error.h"
#include "common/math/vec.h"
#include "common/scene/model/texture.h"

namespace treefarm {

/// What a mesh says of each vertex or triangle for textures to show: "vertex_color", "face_color", "vertex_wear"...
struct MeshAttribute {
    std::string name;         ///< begins with "face_" if it is of triangles
    std::vector<Rgb> values;  ///< linear; one per position, or per triangle; numbers are grey

    static bool is_of_faces(const std::string& name) { return name.starts_with("face_"); }
    bool is_of_faces() const { return is_of_faces(name); }
};

/// An indexed triangle mesh in world space (or its group's space).
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;              ///< unit shading normals, one per position; empty: use the triangle's own
    std::vector<Vec2> uvs;                  ///< one per position; empty: none
    std::vector<std::uint32_t> indices;     ///< three per triangle, counter-clockwise seen from the front
    std::vector<MeshAttribute> attributes;  ///< after checks, only those that a texture asks for

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
};

/// An analytic sphere. Its texture coordinates are (azimuth about `pole` from `meridian`, angle from `pole`), over 2 pi
/// and pi.
struct Sphere {
    Vec3 center{0.0f};
    float radius = 1.0f;
    bool flip_normals = false;                                ///< normals point inwards
    Vec3 pole{0.0f, 0.0f, 1.0f}, meridian{1.0f, 0.0f, 0.0f};  ///< unit, at right angles
    bool mirrored = false;                                    ///< the azimuth runs clockwise about the pole
};

/// A flat ellipse: center + a * half_u + b * half_v for a^2 + b^2 <= 1, seen from the front where
/// cross(half_u, half_v) points. Texture coordinates: (radius, azimuth over 2 pi) of (a, b).
struct Disk {
    Vec3 center{0.0f};
    Vec3 half_u{1.0f, 0.0f, 0.0f}, half_v{0.0f, 1.0f, 0.0f};  ///< at right angles or not, but not parallel
    bool mirrored = false;                                    ///< the azimuth is that of (a, -b)
};

/// The side of a cylinder, without caps. Texture coordinates: (azimuth from `meridian` over 2 pi, place along the
/// axis).
struct Cylinder {
    Vec3 p0{0.0f}, p1{0.0f, 0.0f, 1.0f};
    float radius = 1.0f;
    bool flip_normals = false;        ///< normals point inwards
    Vec3 meridian{1.0f, 0.0f, 0.0f};  ///< unit, at right angles to the axis
    bool mirrored = false;            ///< the azimuth runs clockwise about the axis
};

/// All shapes of a group, placed by a transform that can be inverted.
struct Instance {
    std::int32_t group = kNone;
    Imath::M44f to_world;  ///< of row vectors: p' = p * to_world
};

/// Something that rays can hit. Its place in Scene::shapes is its id everywhere (the geometry's id, the emitter table).
struct Shape {
    std::variant<Mesh, Sphere, Disk, Cylinder, Instance> geometry;
    std::int32_t material = kNone;  ///< kNone for instances only: their group's shapes have their own
    std::int32_t emitter = kNone;   ///< index of an area emitter on the front side, or kNone; never in a group
    std::int32_t group = kNone;  ///< the group it belongs to, below Scene::group_count; kNone: it stands in the world
    std::string name;
    Location where;
};

/// Box of a shape's own surface, in its group's space; empty for instances.
Box3 own_box(const Shape& shape);

}  // namespace treefarm
