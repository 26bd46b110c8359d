// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/obj_materials.h"

namespace treefarm::mitsuba {

/// Part of an OBJ file's mesh with one material.
struct ObjPart {
    Mesh mesh;
    ObjMaterial material;
};

/// Reads the mesh of <shape type="obj">, "ply" or "serialized". If the file has no normals, smooth ones are computed
/// unless face_normals is set; otherwise they decide on the front. With a mirroring transformation the front is kept
/// for files without normals in versions 2 and 3 and for serialized files; in version 0 it is reversed for the others,
/// as in Mitsuba.
Mesh read_ply_mesh(Properties& properties, Diagnostics& diagnostics);
Mesh read_serialized_mesh(Properties& properties, Diagnostics& diagnostics);
std::vector<ObjPart> read_obj_parts(Properties& properties, MaterialReader& materials, bool on_emitter,
                                    Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
