// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/mesh_options.h"

#include <algorithm>
#include <cmath>

#include "coordinator/input/meshes/mesh_normals.h"

namespace treefarm::mitsuba {

namespace {

std::size_t count_zeros(const std::vector<Vec3>& vectors) {
    return static_cast<std::size_t>(std::count(vectors.begin(), vectors.end(), Vec3(0.0f)));
}

}  // namespace

MeshOptions read_mesh_options(Properties& properties, bool flip_tex_coords) {
    if (!properties.has("filename"))
        throw InputError(properties.where(), properties.title() + " has no file name",
                         R"(add <string name="filename" value="..."/>)");
    MeshOptions options;
    options.file = properties.text("filename", "");
    options.face_normals = properties.boolean("face_normals", false);
    options.flip_normals = properties.boolean("flip_normals", false);
    options.flip_tex_coords = properties.boolean("flip_tex_coords", flip_tex_coords);
    options.to_world = properties.transform("to_world");
    options.mirror_keeps_front = properties.element().version >= 2;
    if (properties.element().version < 2 && properties.has("max_smooth_angle")) {
        options.max_smooth_angle = properties.number("max_smooth_angle", 0.0);
        if (options.face_normals)
            throw InputError(properties.where("max_smooth_angle"), "faceNormals and maxSmoothAngle contradict",
                             "remove one of them");
    }
    return options;
}

void transform_mesh(Mesh& mesh, const MeshOptions& options, const Location& where, Diagnostics& diagnostics) {
    const std::size_t without = mesh.normals.empty() ? mesh.positions.size() : count_zeros(mesh.normals);
    for (Vec3& position : mesh.positions)
        position = transform_point(options.to_world, position);
    if (options.face_normals || options.max_smooth_angle) mesh.normals.clear();
    if (!mesh.normals.empty()) {
        const NormalTransform to_world(options.to_world);
        for (Vec3& normal : mesh.normals)
            normal = to_world(normal);
    } else if (options.mirror_keeps_front && is_mirroring(options.to_world)) {
        flip_winding(mesh);
    }
    if (options.flip_tex_coords)
        for (Vec2& uv : mesh.uvs)
            uv.y = 1.0f - uv.y;
    if (options.face_normals) {
        if (options.flip_normals) flip_winding(mesh);
        return;
    }
    if (options.max_smooth_angle) split_at_edges(mesh, std::cos(*options.max_smooth_angle * M_PI / 180.0));
    compute_missing_normals(mesh);
    if (options.flip_normals)
        for (Vec3& normal : mesh.normals)
            normal = -normal;
    orient_by_normals(mesh);
    drop_redundant_normals(mesh);
    if (without > 0 && !mesh.normals.empty())
        diagnostics.find({Finding::Severity::note, "missing normals", where,
                          std::to_string(without) + " of " + std::to_string(mesh.positions.size()) +
                              " vertices of the mesh have no normal: they get the mean of their triangles'",
                          "set faceNormals if facets are meant, or export normals"});
}

}  // namespace treefarm::mitsuba
