// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace treefarm {

inline constexpr std::int32_t kNone = -1;

/// Pixels in memory, row by row from the top, channels interleaved: 8 bits with a decoding table, or linear floats.
struct TextureImage {
    int width = 0, height = 0;        ///< pixels, 1 to 65535
    int channels = 3;                 ///< 1 or 3
    std::vector<std::uint8_t> bytes;  ///< width * height * channels, or empty
    std::array<float, 256> decode{};  ///< linear value of each byte: gamma is computed once, by the reader
    std::vector<float> floats;        ///< width * height * channels, or empty
    std::string name;                 ///< file of the image

    bool empty() const { return width == 0; }
};

/// Mean of all linear values; 0 if there are none.
float mean_value(const TextureImage& image);

}  // namespace treefarm
