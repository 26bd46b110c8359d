// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/input/meshes/obj_file.h"
#include "coordinator/input/mitsuba/materials.h"

namespace treefarm::mitsuba {

/// Material and emission of the triangles of one material of an OBJ file.
struct ObjMaterial {
    std::int32_t material = kNone;  ///< of the scene
    Rgb emission{0.0f};             ///< radiance of the material library's Ke
    Location where;                 ///< of the emission
};

/// The materials of the triangles before any usemtl, then those of ObjFile::materials. A BSDF inside the shape that is
/// named like a material (by name or id) is that material's; one without such a name is everybody's. Where there is
/// neither, materials come from the MTL files, if `load_libraries`, or are the default one.
std::vector<ObjMaterial> assign_obj_materials(const ObjFile& obj, const std::filesystem::path& file,
                                              bool load_libraries, bool on_emitter, Properties& properties,
                                              MaterialReader& materials, Diagnostics& diagnostics);

/// The BSDF of a shape that has one material, or nullptr. A second one throws InputError or, in a file of version 0,
/// holds.
const XmlElement* bsdf_of(Properties& properties, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
