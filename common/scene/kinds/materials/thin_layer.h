// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// A layer that scatters light once, with the index of refraction of its surroundings (Hanrahan and Krueger 1993;
/// Mitsuba 0.6's hk): milk glass, leaves, a stain. Light that would scatter more often is lost.
struct ThinLayerMaterial {
    static constexpr float kMostCosine = 0.99f;

    ColorInput scattering{Rgb(1.0f)}, absorption{Rgb(1.0f)};  ///< optical depths along the normal, 0 or more
    FloatInput mean_cosine{0.0f};  ///< g of Henyey and Greenstein's phase function, above 0 forwards; [-0.99, 0.99]
    bool passes = true;            ///< light is transmitted; otherwise that part is lost

    static constexpr KindEffect kEffect{"thin_layers", "thin layer"};
    Lobes lobes() const {
        return {.glossy_reflection = true, .glossy_transmission = passes, .delta_transmission = passes};
    }
    ThinLayerMaterial opaque() const {
        ThinLayerMaterial layer = *this;
        layer.passes = false;
        return layer;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.number("depth of scattering", self.scattering, 0.0f, 1e30f);
        visitor.number("depth of absorption", self.absorption, 0.0f, 1e30f);
        visitor.number("mean cosine of scattering", self.mean_cosine, -kMostCosine, kMostCosine);
        visitor.flag("light passes", self.passes);
    }
};

}  // namespace treefarm
