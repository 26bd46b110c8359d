// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "common/scene/model/shape.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Options of all shapes that read a mesh from a file.
struct MeshOptions {
    std::filesystem::path file;
    bool face_normals = false;               ///< no shading normals, whatever the file has
    bool flip_normals = false;               ///< the front is the other side
    bool flip_tex_coords = false;            ///< v becomes 1 - v
    std::optional<double> max_smooth_angle;  ///< degrees: normals of the file are dropped, edges above are sharp
    Matrix to_world;
    bool mirror_keeps_front = false;  ///< under a mirroring transformation, of a file without normals
};

/// Reads the common properties. InputError without a file name, and for contradictions.
MeshOptions read_mesh_options(Properties& properties, bool flip_tex_coords);

/// Brings a mesh in object space, its normals as written or none, into the world: computes the normals that are
/// missing, and turns triangles so that their front is where the normals point.
void transform_mesh(Mesh& mesh, const MeshOptions& options, const Location& where, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
