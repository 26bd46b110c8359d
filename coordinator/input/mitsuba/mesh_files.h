// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/obj_materials.h"

namespace treefarm::mitsuba {

/// A part of an OBJ file's mesh that has one material.
struct ObjPart {
    Mesh mesh;
    ObjMaterial material;
};

/// The meshes of <shape type="obj">, "ply" and "serialized". Where the file has no normals, smooth ones are computed
/// unless face_normals is set; where it has them, they decide which side is the front. A mirroring transformation keeps
/// the front of a file without normals in versions 2 and 3 and of serialized files; in version 0 it reverses that of
/// the others, as Mitsuba does.
Mesh read_ply_mesh(Properties& properties, Diagnostics& diagnostics);
Mesh read_serialized_mesh(Properties& properties, Diagnostics& diagnostics);
std::vector<ObjPart> read_obj_parts(Properties& properties, MaterialReader& materials, bool on_emitter,
                                    Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
