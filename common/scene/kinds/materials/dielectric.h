// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/plastic.h"

namespace treefarm {

/// Reflection of a dielectric for light from outside, as a coat over black: replaces glass that is not simulated.
inline PlasticMaterial reflection_alone(float eta, const ColorInput& reflectance, const Roughness& roughness) {
    PlasticMaterial coat;
    coat.eta = eta < 1.0f ? 1.0f / eta : eta;
    coat.diffuse_reflectance = Rgb(0.0f);
    coat.specular_reflectance = reflectance;
    coat.roughness = roughness;
    coat.roughness.alpha_v = coat.roughness.alpha_u;
    return coat;
}

/// Boundary between two transparent media. Radiance is scaled by 1/eta^2 when it enters the denser one.
struct DielectricMaterial {
    /// Index of refraction of the side opposite to the normal over that of the normal's side, above 0.
    float eta = 1.5046f;
    ColorInput specular_reflectance{Rgb(1.0f)}, specular_transmittance{Rgb(1.0f)};
    Roughness roughness;

    Lobes lobes() const { return roughness.lobes(true); }
    PlasticMaterial opaque() const { return reflection_alone(eta, specular_reflectance, roughness); }
    static void fields(auto& self, auto& visitor) {
        visitor.eta(self.eta);
        visitor.fraction("specular reflectance", self.specular_reflectance);
        visitor.fraction("specular transmittance", self.specular_transmittance);
        visitor.roughness(self.roughness, false);
    }
};

}  // namespace treefarm
