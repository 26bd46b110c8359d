// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/shapes.h"

#include <array>

#include "common/base/text/parse_text.h"
#include "coordinator/input/meshes/mesh_normals.h"
#include "coordinator/input/mitsuba/mesh_files.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::string_view kShapes[] = {"obj",    "ply",  "serialized", "rectangle",  "cube",
                                        "sphere", "disk", "cylinder",   "shapegroup", "instance"};

/// Parallelogram: centre, and half edges along which u and v increase.
struct Patch {
    Vec3 center, half_u, half_v;
};

/// Mesh of flat faces whose fronts are where half_u x half_v points, or half_v x half_u if `turned`. Fronts stay on the
/// same side of the object under a mirroring transformation.
Mesh mesh_of_patches(std::span<const Patch> patches, bool turned, Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    const bool flip = properties.boolean("flip_normals", false);
    Mesh mesh;
    for (const Patch& patch : patches) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) {
            const Vec3 corner =
                patch.center + patch.half_u * (2.0f * uv.x - 1.0f) + patch.half_v * (2.0f * uv.y - 1.0f);
            mesh.positions.push_back(transform_point(to_world, corner));
            mesh.uvs.push_back(uv);
        }
        for (const std::uint32_t i : {0u, 1u, 2u, 2u, 3u, 0u})
            mesh.indices.push_back(first + i);
    }
    if ((flip != is_mirroring(to_world)) != turned) flip_winding(mesh);
    return mesh;
}

/// Reads the square from (-1, -1, 0) to (1, 1, 0), front towards +z.
Mesh read_rectangle(Properties& properties) {
    const Patch patch = {Vec3(0.0f), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    return mesh_of_patches(std::span(&patch, 1), false, properties);
}

/// Reads the cube from (-1, -1, -1) to (1, 1, 1), front outside. Texture coordinates as in Mitsuba 0.6 and 3
/// (cube.cpp).
Mesh read_cube(Properties& properties) {
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const std::array<Patch, 6> patches = {{{-y, z, x}, {y, -x, -z}, {x, y, -z}, {z, y, x}, {-x, y, z}, {-z, -y, x}}};
    return mesh_of_patches(patches, true, properties);
}

}  // namespace

std::optional<decltype(Shape::geometry)> read_geometry(Properties& properties, Diagnostics& diagnostics) {
    const std::string type = properties.type();
    if (type == "ply") return read_ply_mesh(properties, diagnostics);
    if (type == "serialized") return read_serialized_mesh(properties, diagnostics);
    if (type == "rectangle") return read_rectangle(properties);
    if (type == "cube") return read_cube(properties);
    if (type == "sphere") return read_sphere(properties);
    if (type == "disk") return read_disk(properties);
    if (type == "cylinder") return read_cylinder(properties);
    diagnostics.unsupported(
        properties.where(), "the shape " + in_quotes(type) + " is not available in this version",
        did_you_mean(type, kShapes,
                     "use obj, ply, serialized, rectangle, cube, sphere, disk, cylinder, shapegroup or instance"));
    return std::nullopt;
}

}  // namespace treefarm::mitsuba
