// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

/// Parallel light.
struct DirectionalEmitter {
    Vec3 direction{0.0f, 0.0f, 1.0f};  ///< unit length, along which the light travels
    Rgb irradiance{1.0f};              ///< W / m^2 on a surface perpendicular to it

    static constexpr EmitterTraits kTraits{LightType::delta, "directional", "directional emitter"};
    std::optional<LightCone> cone() const { return std::nullopt; }
    float radiance_scale(const LitScene&) const { return average(irradiance); }
    static void fields(auto& self, auto& visitor) {
        visitor.direction(self.direction);
        visitor.light("irradiance", self.irradiance);
    }
};

}  // namespace treefarm
