// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

/// Radiance of a distant sphere. The direction d, in the emitter's frame (d . x_axis, d . y_axis, d . z_axis), is at u
/// = atan2(x, -z) / (2 pi) and v = acos(y) / pi of the image: v runs down from the pole y, u repeats.
struct EnvironmentEmitter {
    std::int32_t image = kNone;  ///< index in Scene::images; three linear channels
    float scale = 1.0f;
    Vec3 x_axis{1.0f, 0.0f, 0.0f}, y_axis{0.0f, 1.0f, 0.0f}, z_axis{0.0f, 0.0f, 1.0f};  ///< orthonormal
    /// The centres of the first and the last row of pixels are at the poles (Mitsuba 2 and 3), not their edges (0.6).
    bool rows_at_poles = false;

    static constexpr EmitterTraits kTraits{LightType::environment, "environment_map", "environment map"};
    float radiance_scale(const LitScene& scene) const {
        return scale * mean_value(scene.images[static_cast<std::size_t>(image)]);
    }
    bool at_right_angles() const {
        return std::abs(dot(x_axis, y_axis)) <= 1e-3f && std::abs(dot(y_axis, z_axis)) <= 1e-3f &&
               std::abs(dot(z_axis, x_axis)) <= 1e-3f;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.image(self.image);
        visitor.light("scale", self.scale);
        visitor.direction(self.x_axis);
        visitor.direction(self.y_axis);
        visitor.direction(self.z_axis);
        visitor.rule(self.at_right_angles(), "the environment's axes are not at right angles", "only rotate it");
        visitor.flag("rows_at_poles", self.rows_at_poles);
    }
};

}  // namespace treefarm
