// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

/// A point that projects a picture along `axis`, like Mitsuba's projector: on a plane across the axis at any distance
/// z, the irradiance is that of the picture over z^2.
struct ProjectorEmitter {
    Vec3 position{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};  ///< unit length, away from the emitter
    Vec3 x_axis{1.0f, 0.0f, 0.0f},
        y_axis{0.0f, 1.0f, 0.0f};                 ///< unit length, at right angles: directions of increasing u and v
    float half_width = 1.0f, half_height = 1.0f;  ///< of the picture on the plane at distance 1, above 0
    ColorInput irradiance{Rgb(1.0f)};             ///< W / m^2 on that plane

    static constexpr EmitterTraits kTraits{LightType::delta, "projector", "projector emitter"};
    std::optional<LightCone> cone() const {
        return LightCone{position, axis, std::atan(std::sqrt(half_width * half_width + half_height * half_height))};
    }
    float radiance_scale(const LitScene& scene) const { return average(irradiance.value) / scene.distance2; }
    static bool is_extent(float half) { return half > 0.0f && half <= 1e6f && 1.0f / half <= 1e6f; }
    bool at_right_angles() const {
        return std::abs(dot(axis, x_axis)) <= 1e-3f && std::abs(dot(axis, y_axis)) <= 1e-3f &&
               std::abs(dot(x_axis, y_axis)) <= 1e-3f;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.position(self.position);
        visitor.direction(self.axis);
        visitor.direction(self.x_axis);
        visitor.direction(self.y_axis);
        visitor.rule(self.at_right_angles(), "the projector's axes are not at right angles", "only rotate it");
        visitor.value(self.half_width);
        visitor.value(self.half_height);
        visitor.rule(is_extent(self.half_width) && is_extent(self.half_height),
                     "the projector's field of view is 0 or 180 degrees, to one side at least",
                     "give an angle between");
        visitor.light("irradiance", self.irradiance);
    }
};

}  // namespace treefarm
