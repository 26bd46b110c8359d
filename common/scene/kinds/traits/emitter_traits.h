// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/scene/kinds/traits/inputs.h"

namespace treefarm {

/// Origin of an emitter's light, which decides the techniques that find it.
enum class LightType : std::uint8_t {
    area,         ///< a shape, which rays hit
    delta,        ///< a point, or a single direction: only sampling finds it
    environment,  ///< infinity, seen by rays that hit nothing; at most one per scene
};

/// Properties of a kind of emitter.
struct EmitterTraits {
    LightType type;
    const char* effect;  ///< "spot": name of its row in the table of effects (common/config/effects/light.h)
    const char* title;   ///< "spot emitter"
};

/// Cone that contains all directions in which a point emits.
struct LightCone {
    Vec3 apex{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};  ///< unit length
    float half_angle = kPi;       ///< radians, up to pi
};

/// Facts about the scene for estimating an emitter's brightness.
struct LitScene {
    float distance2;  ///< square of half the diagonal of the scene's box
    std::span<const TextureImage> images;
};

}  // namespace treefarm
