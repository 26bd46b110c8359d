// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

/// Emission of `radiance` from the front of a shape, equal in all directions of the hemisphere.
struct AreaEmitter {
    ColorInput radiance{Rgb(1.0f)};  ///< W / (m^2 sr), per channel
    std::int32_t shape = kNone;

    static constexpr EmitterTraits kTraits{LightType::area, "area", "area emitter"};
    float radiance_scale(const LitScene&) const { return average(radiance.value); }
    static void fields(auto& self, auto& visitor) {
        visitor.light("radiance", self.radiance);
        visitor.shape(self.shape);
    }
};

}  // namespace treefarm
