// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/roughness.h"

namespace treefarm {

/// Metal with a complex index of refraction eta + i k per channel, relative to the outside. eta = 0, k = 1: a perfect
/// mirror.
struct ConductorMaterial {
    Rgb eta{0.0f}, k{1.0f};
    ColorInput specular_reflectance{Rgb(1.0f)};  ///< factor on the reflection, in [0, 1]
    Roughness roughness;

    Lobes lobes() const { return roughness.lobes(false); }
    static void fields(auto& self, auto& visitor) {
        visitor.metal(self.eta, self.k);
        visitor.fraction("specular reflectance", self.specular_reflectance);
        visitor.roughness(self.roughness, false);
    }
};

}  // namespace treefarm
