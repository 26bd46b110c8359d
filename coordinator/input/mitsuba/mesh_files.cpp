// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/mesh_files.h"

#include "coordinator/input/meshes/ply_file.h"
#include "coordinator/input/meshes/serialized_file.h"
#include "coordinator/input/mitsuba/mesh_options.h"

namespace treefarm::mitsuba {
namespace {

void require_triangles(const Mesh& mesh, const std::filesystem::path& file) {
    if (mesh.indices.empty())
        throw InputError(Location{file.string()}, "the file has no faces", "repair it, or remove the shape");
}

}  // namespace

Mesh read_ply_mesh(Properties& properties, Diagnostics& diagnostics) {
    const MeshOptions options = read_mesh_options(properties, false);
    properties.ignore({"srgb"});  // of colours, in 0.6 only
    Mesh mesh = read_ply(options.file, properties.where("filename"));
    require_triangles(mesh, options.file);
    transform_mesh(mesh, options, properties.where(), diagnostics);
    return mesh;
}

Mesh read_serialized_mesh(Properties& properties, Diagnostics& diagnostics) {
    MeshOptions options = read_mesh_options(properties, false);
    options.mirror_keeps_front = true;
    const std::int64_t index = properties.integer("shape_index", 0);
    if (index < 0)
        throw InputError(properties.where("shape_index"), "the shape index is negative", "give a shape index from 0");
    Mesh mesh = read_serialized(options.file, index,
                                properties.where(properties.has("shape_index") ? "shape_index" : "filename"));
    require_triangles(mesh, options.file);
    transform_mesh(mesh, options, properties.where(), diagnostics);
    return mesh;
}

}  // namespace treefarm::mitsuba
