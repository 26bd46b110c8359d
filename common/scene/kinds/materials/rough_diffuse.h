// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// A surface of diffuse facets (Oren and Nayar 1994).
struct RoughDiffuseMaterial {
    ColorInput reflectance{Rgb(0.5f)};  ///< albedo of the facets per channel, in [0, 1]
    FloatInput alpha{0.2f};             ///< root mean square slope of the facets, as for rough metals
    bool fast = false;                  ///< the paper's short form, without interreflection of facets

    static constexpr KindEffect kEffect{"rough_diffuse", "rough diffuse material"};
    Lobes lobes() const { return {.diffuse = true}; }
    static void fields(auto& self, auto& visitor) {
        visitor.fraction("reflectance", self.reflectance);
        visitor.number("roughness alpha", self.alpha, 0.0f, 100.0f);
        visitor.flag("fast", self.fast);
    }
};

}  // namespace treefarm
