// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/dielectric.h"

namespace treefarm {

/// A thin pane: reflections between its two surfaces are summed, transmission is straight.
struct ThinDielectricMaterial {
    float eta = 1.5046f;
    ColorInput specular_reflectance{Rgb(1.0f)}, specular_transmittance{Rgb(1.0f)};

    Lobes lobes() const { return {.delta_reflection = true, .delta_transmission = true}; }
    PlasticMaterial opaque() const { return reflection_alone(eta, specular_reflectance, {}); }
    static void fields(auto& self, auto& visitor) {
        visitor.eta(self.eta);
        visitor.fraction("specular reflectance", self.specular_reflectance);
        visitor.fraction("specular transmittance", self.specular_transmittance);
    }
};

}  // namespace treefarm
