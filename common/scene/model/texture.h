// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "common/base/error.h"
#include "common/math/vec.h"

namespace treefarm {

inline constexpr std::int32_t kNone = -1;

/// Pixels as they lie in memory, row by row from the top, channels interleaved: 8 bits with a table that decodes them,
/// or floats that are linear already.
struct TextureImage {
    int width = 0, height = 0;        ///< pixels, 1 to 65535
    int channels = 3;                 ///< 1 or 3
    std::vector<std::uint8_t> bytes;  ///< width * height * channels, or empty
    std::array<float, 256> decode{};  ///< linear value of each byte: gamma is computed once, by the reader
    std::vector<float> floats;        ///< width * height * channels, or empty
    std::string name;                 ///< the file it came from

    bool empty() const { return width == 0; }
};

/// Mean of all linear values; 0 if there are none.
float mean_value(const TextureImage& image);

/// What lies outside of [0, 1) in u or v.
enum class Wrap : std::uint8_t { repeat, mirror, clamp, zero, one };

/// (u, v) -> (u_row . (u, v, 1), v_row . (u, v, 1)), before anything is looked up.
struct UvTransform {
    Vec3 u_row{1.0f, 0.0f, 0.0f};
    Vec3 v_row{0.0f, 1.0f, 0.0f};
    bool operator==(const UvTransform&) const = default;
};

/// Texel (column, row from the top) holds u in [column, column+1) / width and v in [row, row+1) / height: v runs down
/// the image, and the reader turns what its format means otherwise.
struct BitmapTexture {
    std::int32_t image = kNone;  ///< index in Scene::images
    bool bilinear = true;        ///< otherwise the nearest texel
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    UvTransform uv;
};

/// Squares of half a unit: color0 where u and v are both in the lower or both in the upper half of their unit.
struct CheckerboardTexture {
    Rgb color0{0.4f}, color1{0.2f};
    UvTransform uv;
};

struct Texture {
    std::variant<BitmapTexture, CheckerboardTexture> kind;
    std::string name;
    Location where;
};

/// A colour that is the same everywhere or looked up in a texture, and then multiplied by `value`.
struct ColorInput {
    Rgb value{0.0f};
    std::int32_t texture = kNone;  ///< index in Scene::textures

    ColorInput() = default;
    ColorInput(const Rgb& constant, std::int32_t looked_up = kNone) : value(constant), texture(looked_up) {}
    bool varies() const { return texture != kNone; }
    bool operator==(const ColorInput&) const = default;
};

/// A number that is the same everywhere or looked up in a texture (its mean of channels), and then multiplied by
/// `value`.
struct FloatInput {
    float value = 0;
    std::int32_t texture = kNone;

    FloatInput() = default;
    FloatInput(float constant, std::int32_t looked_up = kNone) : value(constant), texture(looked_up) {}
    bool varies() const { return texture != kNone; }
    bool operator==(const FloatInput&) const = default;
};

}  // namespace treefarm
