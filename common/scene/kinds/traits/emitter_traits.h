// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/scene/model/texture.h"

namespace treefarm {

/// Where an emitter's light comes from, and so what finds it.
enum class LightType : std::uint8_t {
    area,         ///< a shape, which rays hit
    delta,        ///< a point, or a single direction: nothing but sampling finds it
    environment,  ///< infinity, where rays go that hit nothing; a scene has one at most
};

/// What a kind of emitter is.
struct EmitterTraits {
    LightType type;
    const char* effect;  ///< "spot": its row in the table of effects (common/config/effects/light.h)
    const char* title;   ///< "spot emitter"
};

/// All directions in which a point shines are within a cone.
struct LightCone {
    Vec3 apex{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};  ///< unit
    float half_angle = kPi;       ///< radians, to pi
};

/// What a guess at an emitter's brightness is made from.
struct LitScene {
    float distance2;  ///< square of half the diagonal of the scene's box
    std::span<const TextureImage> images;
};

}  // namespace treefarm
