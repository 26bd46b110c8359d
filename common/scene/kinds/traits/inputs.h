// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "common/scene/kinds/traits/texture_image.h"

namespace treefarm {

/// A colour: a constant `value`, or a texture times `value`.
struct ColorInput {
    Rgb value{0.0f};
    std::int32_t texture = kNone;  ///< index in Scene::textures

    ColorInput() = default;
    ColorInput(const Rgb& constant, std::int32_t looked_up = kNone) : value(constant), texture(looked_up) {}
    bool varies() const { return texture != kNone; }
    bool operator==(const ColorInput&) const = default;
};

/// A number: a constant `value`, or the mean of a texture's channels times `value`.
struct FloatInput {
    float value = 0;
    std::int32_t texture = kNone;

    FloatInput() = default;
    FloatInput(float constant, std::int32_t looked_up = kNone) : value(constant), texture(looked_up) {}
    bool varies() const { return texture != kNone; }
    bool operator==(const FloatInput&) const = default;
};

}  // namespace treefarm
