// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// Phong's model, modified to be reciprocal and energy-conserving (Lafortune and Willems 1994).
struct PhongMaterial {
    ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(0.2f)};  ///< their sum at most 1
    FloatInput exponent{30.0f};

    static constexpr KindEffect kEffect{"phong", "Phong material"};
    Lobes lobes() const { return {.diffuse = true, .glossy_reflection = true}; }
    static void fields(auto& self, auto& visitor) {
        visitor.fraction("diffuse reflectance", self.diffuse_reflectance);
        visitor.fraction("specular reflectance", self.specular_reflectance);
        visitor.together(self.diffuse_reflectance, self.specular_reflectance);
        visitor.number("exponent", self.exponent, 0.0f, 1e6f);
    }
};

}  // namespace treefarm
