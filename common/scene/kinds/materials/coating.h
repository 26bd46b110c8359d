// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/roughness.h"

namespace treefarm {

/// A dielectric coat, smooth or rough, over another material, as in Mitsuba 0.6 (Weidlich and Wilkie 2007): light is
/// refracted on its way in and out and absorbed in between; light that the coat reflects back to the material is lost.
struct CoatingMaterial {
    float eta = 1.5042f;                         ///< index of refraction of the coat over that of the outside
    ColorInput absorption{Rgb(0.0f)};            ///< optical depth of the coat along its normal, 0 or more
    ColorInput specular_reflectance{Rgb(1.0f)};  ///< factor on the coat's reflection
    Roughness roughness;                         ///< of the coat; isotropic
    std::int32_t coated = kNone;                 ///< index in Scene::materials, smaller than this material's own

    /// The coat reflects on both sides; beneath it are both sides of the other material.
    static constexpr bool kSidesOfParts = true;
    static constexpr KindEffect kEffect{"coatings", "coated material"};
    Lobes lobes() const { return roughness.lobes(false); }
    static void fields(auto& self, auto& visitor) {
        visitor.eta(self.eta);
        visitor.number("optical depth of the coat", self.absorption, 0.0f, 1e30f);
        visitor.fraction("specular reflectance", self.specular_reflectance);
        visitor.roughness(self.roughness, true);
        visitor.part("coated material", self.coated);
    }
};

}  // namespace treefarm
