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
    bool face_normals = false;               ///< no shading normals, even if the file has them
    bool flip_normals = false;               ///< the front is the other side
    bool flip_tex_coords = false;            ///< v becomes 1 - v
    std::optional<double> max_smooth_angle;  ///< degrees: the file's normals are dropped, sharper edges are kept
    Matrix to_world;
    bool mirror_keeps_front = false;  ///< applies to files without normals under a mirroring transformation
};

/// Reads the common properties. Throws InputError without a file name, and for contradictions.
MeshOptions read_mesh_options(Properties& properties, bool flip_tex_coords);

/// Transforms a mesh from object space, with normals as written or none, to the world: computes missing normals, and
/// orients triangles so that their front is on the side of the normals.
void transform_mesh(Mesh& mesh, const MeshOptions& options, const Location& where, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
