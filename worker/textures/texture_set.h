// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// The textures of a scene, ready to be looked up. Immutable; any number of threads may ask.
class TextureSet {
  public:
    TextureSet() = default;
    TextureSet(std::vector<Texture> textures, std::vector<TextureImage> images);

    /// Linear value of a texture at texture coordinates.
    Rgb color(std::int32_t texture, const Vec2& uv) const;
    /// Fetches most of what color() reads.
    void prefetch(std::int32_t texture, const Vec2& uv) const;
    /// Mean of the channels of color().
    float value(std::int32_t texture, const Vec2& uv) const { return average(color(texture, uv)); }
    /// How the value changes with u and v: central differences over half a texel to each side.
    Vec2 gradient(std::int32_t texture, const Vec2& uv) const;

    Rgb eval(const ColorInput& input, const Vec2& uv) const {
        return input.varies() ? input.value * color(input.texture, uv) : input.value;
    }
    float eval(const FloatInput& input, const Vec2& uv) const {
        return input.varies() ? input.value * value(input.texture, uv) : input.value;
    }

    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<TextureImage>& images() const { return images_; }
    /// Bytes that pixels take.
    std::size_t memory() const;

  private:
    std::vector<Texture> textures_;
    std::vector<TextureImage> images_;
};

/// Texel (x, y) of an image, x and y in range; single-channel images are grey.
Rgb texel(const TextureImage& image, int x, int y);
/// Fetches the texel (x, y).
void prefetch_texel(const TextureImage& image, int x, int y);

}  // namespace treefarm
