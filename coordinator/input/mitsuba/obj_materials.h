// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/input/meshes/mtl_file.h"
#include "coordinator/input/meshes/obj_file.h"
#include "coordinator/input/mitsuba/materials.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Material and emission of the triangles of one OBJ material.
struct ObjMaterial {
    std::int32_t material = kNone;  ///< of the scene
    Rgb emission{0.0f};             ///< radiance, from the material library's Ke
    Location where;                 ///< of the emission
};

/// Materials of the triangles before any usemtl, then those of ObjFile::materials. A BSDF inside the shape whose
/// name or id is a material's defines that material; one without such a name defines all. Otherwise they come from the
/// MTL files, if `load_libraries`, or are the default one.
std::vector<ObjMaterial> assign_obj_materials(const ObjFile& obj, const std::filesystem::path& file,
                                              bool load_libraries, bool on_emitter, Properties& properties,
                                              MaterialReader& materials, Diagnostics& diagnostics);

/// BSDF of a shape with one material, or nullptr. A second BSDF throws InputError or, in a file of version 0, replaces
/// the first.
const XmlElement* bsdf_of(Properties& properties, Diagnostics& diagnostics);

/// BSDF for a material of an MTL file, whose maps are in `folder`: diffuse; if Ks is not black, blended with a rough
/// mirror of alpha = sqrt(2 / (Ns + 2)); twosided. The reflectance is Kd plus Ks, scaled down to 1 if it exceeds that.
XmlElement bsdf_of_mtl(const MtlMaterial& material, const std::filesystem::path& folder);

}  // namespace treefarm::mitsuba
