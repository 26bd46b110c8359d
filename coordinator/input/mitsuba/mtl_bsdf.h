// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/input/meshes/mtl_file.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// The BSDF that stands for a material of an MTL file, whose maps lie in `folder`: diffuse, and blended with it, where
/// Ks is not black, a rough mirror of alpha = sqrt(2 / (Ns + 2)); seen from both sides. Together they reflect Kd and
/// Ks, scaled down to 1 where they would reflect more.
XmlElement bsdf_of_mtl(const MtlMaterial& material, const std::filesystem::path& folder);

}  // namespace treefarm::mitsuba
