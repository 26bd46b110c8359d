// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/emitter_traits.h"

namespace treefarm {

/// A point that emits around `axis`: fully within the angle `beam`, not at all beyond `cutoff`, and linearly in the
/// angle in between. A texture is projected like a slide: its unit square fills the square around the circle in which
/// the cone of `cutoff` cuts a plane across the axis.
struct SpotEmitter {
    Vec3 position{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};   ///< unit length, away from the emitter
    Rgb intensity{1.0f};           ///< W / sr, on the axis
    float cutoff = 0.3490659f;     ///< radians, above 0, at most pi
    float beam = 0.2617994f;       ///< radians, 0 to cutoff
    std::int32_t texture = kNone;  ///< factor on the intensity; then cutoff is below pi / 2
    /// Unit vectors at right angles to `axis` and each other: directions of increasing u and v of the texture.
    Vec3 x_axis{1.0f, 0.0f, 0.0f}, y_axis{0.0f, 1.0f, 0.0f};

    static constexpr EmitterTraits kTraits{LightType::delta, "spot", "spot emitter"};
    std::optional<LightCone> cone() const { return LightCone{position, axis, cutoff}; }
    float radiance_scale(const LitScene& scene) const { return average(intensity) / scene.distance2; }
    static void fields(auto& self, auto& visitor) {
        visitor.position(self.position);
        visitor.direction(self.axis);
        visitor.light("intensity", self.intensity);
        visitor.value(self.cutoff);
        visitor.value(self.beam);
        visitor.rule(self.cutoff > 0.0f && self.cutoff <= kPi,
                     "the spot's cutoff angle is not above 0 and at most 180 degrees", "give an angle between");
        visitor.rule(self.beam >= 0.0f && self.beam <= self.cutoff,
                     "the spot's beam is wider than its cutoff angle, or negative",
                     "give a beam width from 0 to the cutoff angle");
        visitor.texture(self.texture);
        visitor.direction(self.x_axis);
        visitor.direction(self.y_axis);
        visitor.rule(self.texture == kNone || self.cutoff < 0.5f * kPi,
                     "the cone of a spot with a texture is a half space or more",
                     "give a cutoff angle below 90 degrees");
    }
};

}  // namespace treefarm
