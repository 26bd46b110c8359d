// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/shape_codec.h"

#include "common/scene/pack/packed_values.h"

namespace treefarm::packed {
namespace {

/// The place of a kind of shape in the variant is its number in packed form; a mesh with attributes has another.
constexpr std::uint8_t kMeshWithAttributes = 5;
constexpr std::size_t kMinAttributeBytes = 2;
using Geometry = decltype(Shape::geometry);
static_assert(std::is_same_v<std::variant_alternative_t<0, Geometry>, Mesh>);
static_assert(std::is_same_v<std::variant_alternative_t<1, Geometry>, Sphere>);
static_assert(std::is_same_v<std::variant_alternative_t<2, Geometry>, Disk>);
static_assert(std::is_same_v<std::variant_alternative_t<3, Geometry>, Cylinder>);
static_assert(std::is_same_v<std::variant_alternative_t<4, Geometry>, Instance>);
static_assert(std::variant_size_v<Geometry> == 5);

std::uint8_t number_of(const Geometry& geometry) {
    const auto* mesh = std::get_if<Mesh>(&geometry);
    return mesh && !mesh->attributes.empty() ? kMeshWithAttributes : static_cast<std::uint8_t>(geometry.index());
}

struct Put {
    ByteWriter& out;

    void operator()(const Mesh& mesh) const {
        put_vectors(out, mesh.positions);
        put_vectors(out, mesh.normals);
        put_vectors(out, mesh.uvs);
        out.put_array(std::span<const std::uint32_t>(mesh.indices));
        if (mesh.attributes.empty()) return;
        put_list(out, mesh.attributes, [](ByteWriter& to, const MeshAttribute& attribute) {
            to.put_string(attribute.name);
            put_vectors(to, attribute.values);
        });
    }
    void operator()(const Sphere& sphere) const {
        put_vector(out, sphere.center);
        out.put(sphere.radius);
        put_flag(out, sphere.flip_normals);
        put_vector(out, sphere.pole);
        put_vector(out, sphere.meridian);
        put_flag(out, sphere.mirrored);
    }
    void operator()(const Disk& disk) const {
        put_vector(out, disk.center);
        put_vector(out, disk.half_u);
        put_vector(out, disk.half_v);
        put_flag(out, disk.mirrored);
    }
    void operator()(const Cylinder& cylinder) const {
        put_vector(out, cylinder.p0);
        put_vector(out, cylinder.p1);
        out.put(cylinder.radius);
        put_flag(out, cylinder.flip_normals);
        put_vector(out, cylinder.meridian);
        put_flag(out, cylinder.mirrored);
    }
    void operator()(const Instance& instance) const {
        const Imath::M44f& m = instance.to_world;
        if (m[0][3] != 0.0f || m[1][3] != 0.0f || m[2][3] != 0.0f || m[3][3] != 1.0f)
            throw FormatError("scene: the transform of an instance is not affine");
        out.put(instance.group);
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column)
                out.put(m[row][column]);
    }
};

Mesh get_mesh(ByteReader& in) {
    Mesh mesh;
    mesh.positions = get_vectors<Vec3>(in);
    mesh.normals = get_vectors<Vec3>(in);
    mesh.uvs = get_vectors<Vec2>(in);
    mesh.indices = in.get_array<std::uint32_t>();
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        throw FormatError("scene: a mesh has " + std::to_string(mesh.normals.size()) + " normals for " +
                          std::to_string(mesh.positions.size()) + " positions");
    if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size())
        throw FormatError("scene: a mesh has " + std::to_string(mesh.uvs.size()) + " texture coordinates for " +
                          std::to_string(mesh.positions.size()) + " positions");
    if (mesh.indices.size() % 3 != 0) throw FormatError("scene: a mesh's indices are no whole triangles");
    for (const std::uint32_t index : mesh.indices)
        if (index >= mesh.positions.size())
            throw FormatError("scene: vertex " + std::to_string(index) + " of " +
                              std::to_string(mesh.positions.size()));
    return mesh;
}

Mesh get_mesh_with_attributes(ByteReader& in) {
    Mesh mesh = get_mesh(in);
    get_list(in, kMinAttributeBytes, mesh.attributes, [&] {
        MeshAttribute attribute;
        attribute.name = in.get_string();
        attribute.values = get_vectors<Rgb>(in);
        const std::size_t wanted = attribute.is_of_faces() ? mesh.triangle_count() : mesh.positions.size();
        if (attribute.values.size() != wanted)
            throw FormatError("scene: a mesh has " + std::to_string(attribute.values.size()) +
                              " values of an attribute for " + std::to_string(wanted));
        return attribute;
    });
    if (mesh.attributes.empty()) throw FormatError("scene: a mesh has attributes, and none");
    return mesh;
}

Sphere get_sphere(ByteReader& in) {
    Sphere sphere;
    sphere.center = get_vector<Vec3>(in);
    sphere.radius = in.get<float>();
    sphere.flip_normals = get_flag(in, "a sphere's flip");
    sphere.pole = get_vector<Vec3>(in);
    sphere.meridian = get_vector<Vec3>(in);
    sphere.mirrored = get_flag(in, "a sphere's mirror");
    return sphere;
}

Disk get_disk(ByteReader& in) {
    Disk disk;
    disk.center = get_vector<Vec3>(in);
    disk.half_u = get_vector<Vec3>(in);
    disk.half_v = get_vector<Vec3>(in);
    disk.mirrored = get_flag(in, "a disk's mirror");
    return disk;
}

Cylinder get_cylinder(ByteReader& in) {
    Cylinder cylinder;
    cylinder.p0 = get_vector<Vec3>(in);
    cylinder.p1 = get_vector<Vec3>(in);
    cylinder.radius = in.get<float>();
    cylinder.flip_normals = get_flag(in, "a cylinder's flip");
    cylinder.meridian = get_vector<Vec3>(in);
    cylinder.mirrored = get_flag(in, "a cylinder's mirror");
    return cylinder;
}

Instance get_instance(ByteReader& in, std::size_t group_count) {
    Instance instance;
    instance.group = get_index(in, group_count, "group");
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column)
            instance.to_world[row][column] = in.get<float>();
    return instance;
}

Geometry get_geometry(ByteReader& in, std::size_t group_count) {
    switch (const auto kind = in.get<std::uint8_t>()) {
        case 0:
            return get_mesh(in);
        case 1:
            return get_sphere(in);
        case 2:
            return get_disk(in);
        case 3:
            return get_cylinder(in);
        case 4:
            return get_instance(in, group_count);
        case kMeshWithAttributes:
            return get_mesh_with_attributes(in);
        default:
            throw FormatError("scene: unknown kind of shape " + std::to_string(kind));
    }
}

}  // namespace

void put_shape(ByteWriter& out, const Shape& shape) {
    out.put(number_of(shape.geometry));
    std::visit(Put{out}, shape.geometry);
    out.put(shape.material);
    out.put(shape.emitter);
    out.put(shape.group);
    out.put_string(shape.name);
    put_location(out, shape.where);
}

Shape get_shape(ByteReader& in, std::size_t material_count, std::size_t group_count) {
    Shape shape;
    shape.geometry = get_geometry(in, group_count);
    const bool is_instance = std::holds_alternative<Instance>(shape.geometry);
    shape.material = get_optional_index(in, material_count, "material");
    shape.emitter = in.get<std::int32_t>();
    shape.group = get_optional_index(in, group_count, "group");
    if (is_instance && (shape.material != kNone || shape.group != kNone || shape.emitter != kNone))
        throw FormatError("scene: an instance has a material or an emitter, or is in a group");
    if (!is_instance && shape.material == kNone) throw FormatError("scene: a shape has no material");
    if (shape.group != kNone && shape.emitter != kNone) throw FormatError("scene: an emitter is in a group");
    shape.name = in.get_string();
    shape.where = get_location(in);
    return shape;
}

}  // namespace treefarm::packed
