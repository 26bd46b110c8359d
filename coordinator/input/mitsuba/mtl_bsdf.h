// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/input/meshes/mtl_file.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// BSDF for a material of an MTL file, whose maps are in `folder`: diffuse; if Ks is not black, blended with a rough
/// mirror of alpha = sqrt(2 / (Ns + 2)); twosided. The reflectance is Kd plus Ks, scaled down to 1 if it exceeds that.
XmlElement bsdf_of_mtl(const MtlMaterial& material, const std::filesystem::path& folder);

}  // namespace treefarm::mitsuba
