// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

struct PointEmitter {
    Vec3 position{0.0f};
    Rgb intensity{1.0f};  ///< W / sr

    static constexpr EmitterTraits kTraits{LightType::delta, "point", "point emitter"};
    std::optional<LightCone> cone() const { return LightCone{position}; }
    float radiance_scale(const LitScene& scene) const { return average(intensity) / scene.distance2; }
    static void fields(auto& self, auto& visitor) {
        visitor.position(self.position);
        visitor.light("intensity", self.intensity);
    }
};

}  // namespace treefarm
