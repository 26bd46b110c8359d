// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace treefarm {

struct ImageSize {
    int width = 0, height = 0;  ///< pixels
};

/// An image as stored in a file, row by row from the top, channels interleaved: grey, grey and alpha, RGB or RGBA.
struct Pixels {
    int width = 0, height = 0, channels = 0;
    std::vector<std::uint8_t> bytes;  ///< of a file with at most 8 bits; 255 is white
    std::vector<float> floats;        ///< of other files; 1 is white

    std::size_t row_values() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels); }
};

}  // namespace treefarm
