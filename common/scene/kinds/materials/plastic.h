// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/roughness.h"

namespace treefarm {

/// A diffuse base under a dielectric coat.
struct PlasticMaterial {
    float eta = 1.49f;
    ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(1.0f)};
    bool nonlinear = false;  ///< colour shifts by interreflection inside the coat
    Roughness roughness;     ///< of the coat; isotropic
    /// A rough coat returns to the base only the light that its facets reflect once (Mitsuba 2 and 3), and the rest of
    /// the light that does not leave is lost; otherwise it returns all of that (0.6).
    bool single_return = false;

    static constexpr bool kCoated = true;
    Lobes lobes() const {
        Lobes lobes = roughness.lobes(false);
        lobes.diffuse = true;
        return lobes;
    }
    /// Whether reflectances above 1 must be refused: interreflection between base and coat would grow without end.
    bool needs_limit() const { return nonlinear; }
    static void fields(auto& self, auto& visitor) {
        visitor.eta(self.eta);
        visitor.fraction("diffuse reflectance", self.diffuse_reflectance);
        visitor.fraction("specular reflectance", self.specular_reflectance);
        visitor.flag("nonlinear", self.nonlinear);
        visitor.roughness(self.roughness, true);
        visitor.flag("single_return", self.single_return);
    }
};

}  // namespace treefarm
