// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "common/scene/kinds/fields.h"
#include "common/scene/kinds/materials/blend.h"
#include "common/scene/kinds/materials/coating.h"
#include "common/scene/kinds/materials/conductor.h"
#include "common/scene/kinds/materials/dielectric.h"
#include "common/scene/kinds/materials/diffuse.h"
#include "common/scene/kinds/materials/diffuse_transmitter.h"
#include "common/scene/kinds/materials/null.h"
#include "common/scene/kinds/materials/phong.h"
#include "common/scene/kinds/materials/plastic.h"
#include "common/scene/kinds/materials/principled.h"
#include "common/scene/kinds/materials/principled_thin.h"
#include "common/scene/kinds/materials/rough_diffuse.h"
#include "common/scene/kinds/materials/thin_dielectric.h"
#include "common/scene/kinds/materials/thin_layer.h"
#include "common/scene/kinds/materials/ward.h"

namespace treefarm {

/// All kinds of materials. The index of a kind is its number in packed form: new kinds come last.
using MaterialKind =
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, ThinDielectricMaterial, PlasticMaterial,
                 BlendMaterial, NullMaterial, RoughDiffuseMaterial, PhongMaterial, WardMaterial, PrincipledMaterial,
                 CoatingMaterial, PrincipledThinMaterial, DiffuseTransmitterMaterial, ThinLayerMaterial>;

}  // namespace treefarm
