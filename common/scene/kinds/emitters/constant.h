// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

/// Emission of `radiance` from infinity, equal in all directions.
struct ConstantEmitter {
    Rgb radiance{1.0f};

    static constexpr EmitterTraits kTraits{LightType::environment, "constant", "constant emitter"};
    float radiance_scale(const LitScene&) const { return average(radiance); }
    static void fields(auto& self, auto& visitor) { visitor.light("radiance", self.radiance); }
};

}  // namespace treefarm
