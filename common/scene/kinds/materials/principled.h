// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// Disney's principled BSDF (Burley 2012 and 2015), as in Mitsuba 3: a diffuse base with retroreflection, a flat
/// subsurface look and sheen, a specular lobe that is dielectric, tinted or metallic, a clear coat, and refraction.
struct PrincipledMaterial {
    ColorInput base_color{Rgb(0.5f)};
    FloatInput roughness{0.5f};  ///< alpha is its square
    FloatInput anisotropic{0.0f}, metallic{0.0f}, spec_trans{0.0f}, spec_tint{0.0f};
    FloatInput sheen{0.0f}, sheen_tint{0.0f}, flatness{0.0f};
    FloatInput clearcoat{0.0f}, clearcoat_gloss{0.0f};
    float eta = 1.5f;  ///< index of refraction of the inside over the outside; not 1 with transmission

    bool transmits() const { return spec_trans.varies() || spec_trans.value > 0.0f; }
    static constexpr KindEffect kEffect{"principled", "principled material"};
    Lobes lobes() const { return {.diffuse = true, .glossy_reflection = true, .glossy_transmission = transmits()}; }
    /// Opaque form: transmitted light is lost, and the base is darker by that share.
    PrincipledMaterial opaque() const {
        PrincipledMaterial material = *this;
        if (!spec_trans.varies()) material.base_color.value *= 1.0f - spec_trans.value;
        material.spec_trans = 0.0f;
        return material;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.fraction("base color", self.base_color);
        visitor.fraction("roughness", self.roughness);
        visitor.anisotropy(self.anisotropic);
        visitor.fraction("metallic share", self.metallic);
        visitor.fraction("specular transmission", self.spec_trans);
        visitor.fraction("specular tint", self.spec_tint);
        visitor.fraction("sheen", self.sheen);
        visitor.fraction("sheen tint", self.sheen_tint);
        visitor.fraction("flatness", self.flatness);
        visitor.fraction("clear coat", self.clearcoat);
        visitor.fraction("gloss of the clear coat", self.clearcoat_gloss);
        visitor.eta(self.eta);
    }
};

}  // namespace treefarm
