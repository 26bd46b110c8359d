#include "common/scene/mitsuba/shapes.h"

#include <array>
#include <cmath>

#include "common/config/parse_text.h"
#include "common/scene/mesh_normals.h"
#include "common/scene/mitsuba/obj_mesh.h"

namespace treefarm::mitsuba {
namespace {

/// A flat face of four corners, object space; its front is where it turns left.
struct Quad {
    std::array<Vec3, 4> corners;
};

/// A mesh of flat faces. Its front stays on the same side of the object under a mirroring transformation.
Mesh mesh_of_quads(std::span<const Quad> quads, const Matrix& to_world, bool flip) {
    constexpr std::array<Vec2, 4> uvs = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    Mesh mesh;
    for (const Quad& quad : quads) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::size_t i = 0; i < 4; ++i) {
            mesh.positions.push_back(transform_point(to_world, quad.corners[i]));
            mesh.uvs.push_back(uvs[i]);
        }
        for (const std::uint32_t i : {0u, 1u, 2u, 2u, 3u, 0u})
            mesh.indices.push_back(first + i);
    }
    if (flip != is_mirroring(to_world)) flip_winding(mesh);
    return mesh;
}

/// From (-1, -1, 0) to (1, 1, 0), front towards +z.
Mesh read_rectangle(Properties& properties) {
    const Quad quad = {{Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}};
    const bool flip = properties.boolean("flip_normals", false);
    return mesh_of_quads(std::span(&quad, 1), properties.transform("to_world"), flip);
}

/// From (-1, -1, -1) to (1, 1, 1), front outside.
Mesh read_cube(Properties& properties) {
    std::array<Quad, 6> quads;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const float side = face % 2 == 0 ? -1.0f : 1.0f;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        constexpr float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (std::size_t i = 0; i < 4; ++i) {
            // Seen from outside the corners turn left: on the negative side the order is the reverse.
            const std::size_t at = side > 0.0f ? i : 3 - i;
            Vec3& corner = quads[static_cast<std::size_t>(face)].corners[at];
            corner[axis] = side;
            corner[u] = signs[i][0];
            corner[v] = signs[i][1];
        }
    }
    const bool flip = properties.boolean("flip_normals", false);
    return mesh_of_quads(quads, properties.transform("to_world"), flip);
}

Sphere read_sphere(Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    const double scale = uniform_scale(to_world);
    if (!(scale > 0.0))
        throw InputError(properties.where("to_world"), "the sphere's transformation scales axes differently or shears",
                         "an ellipsoid is not available in this version: scale all axes alike");
    Sphere sphere;
    const Vec3 center = properties.point("center", Vec3(0.0f));
    sphere.radius = static_cast<float>(properties.positive("radius", 1.0) * scale);
    sphere.flip_normals = properties.boolean("flip_normals", false);
    if (properties.element().version >= 2) {
        sphere.center = transform_point(to_world, center);
        if (is_mirroring(to_world)) sphere.flip_normals = !sphere.flip_normals;
    } else {
        // Mitsuba 0.6 takes the scale out of the transformation before it moves the centre.
        sphere.center = transform_point(to_world, center * static_cast<float>(1.0 / scale));
    }
    return sphere;
}

}  // namespace

std::optional<decltype(Shape::geometry)> read_geometry(Properties& properties, Diagnostics& diagnostics) {
    const std::string type = properties.type();
    if (type == "obj") return read_obj_mesh(properties, diagnostics);
    if (type == "rectangle") return read_rectangle(properties);
    if (type == "cube") return read_cube(properties);
    if (type == "sphere") return read_sphere(properties);
    diagnostics.unsupported(properties.where(), "the shape " + in_quotes(type) + " is not available in this version",
                            "use obj, rectangle, cube or sphere");
    return std::nullopt;
}

}  // namespace treefarm::mitsuba
