// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// Disney's principled BSDF of a thin sheet (Burley 2015), as in Mitsuba 3: light is reflected or passes straight
/// through, by rough facets or diffusely. Both sides are equal.
struct PrincipledThinMaterial {
    ColorInput base_color{Rgb(0.5f)};
    FloatInput roughness{0.5f};  ///< alpha is its square; for transmission scaled by the index of refraction
    FloatInput anisotropic{0.0f}, spec_trans{0.0f}, spec_tint{0.0f};
    FloatInput sheen{0.0f}, sheen_tint{0.0f}, flatness{0.0f};
    FloatInput diff_trans{0.0f};  ///< 0 to 2: twice the share of diffuse light that is transmitted
    FloatInput eta{1.5f};         ///< index of refraction of the sheet over that of its surroundings

    static constexpr float kMostDiffTrans = 2.0f;
    bool transmits() const {
        return spec_trans.varies() || spec_trans.value > 0.0f || diff_trans.varies() || diff_trans.value > 0.0f;
    }
    static constexpr KindEffect kEffect{"principled_thin", "thin principled material"};
    Lobes lobes() const { return {.diffuse = true, .glossy_reflection = true, .glossy_transmission = transmits()}; }
    /// Opaque form: transmitted light and the reflection of the facets are lost, and the base is darker by
    /// that share.
    PrincipledThinMaterial opaque() const {
        PrincipledThinMaterial material = *this;
        if (!spec_trans.varies()) material.base_color.value *= 1.0f - spec_trans.value;
        if (!diff_trans.varies()) material.base_color.value *= 1.0f - diff_trans.value / kMostDiffTrans;
        material.spec_trans = material.diff_trans = 0.0f;
        return material;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.fraction("base color", self.base_color);
        visitor.fraction("roughness", self.roughness);
        visitor.anisotropy(self.anisotropic);
        visitor.fraction("specular transmission", self.spec_trans);
        visitor.fraction("specular tint", self.spec_tint);
        visitor.fraction("sheen", self.sheen);
        visitor.fraction("sheen tint", self.sheen_tint);
        visitor.fraction("flatness", self.flatness);
        visitor.number("diffuse transmission", self.diff_trans, 0.0f, kMostDiffTrans);
        visitor.number("index of refraction", self.eta, 1e-3f, 1e3f);
    }
};

}  // namespace treefarm
