// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace treefarm::test {

/// A PNG file without compression.
struct TinyPng {
    int width = 1, height = 1;
    int channels = 3;                   ///< 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA
    int bits = 8;                       ///< 8 or 16
    std::vector<std::uint16_t> values;  ///< rows from the top
    double gamma = 0.0;                 ///< value of the gAMA chunk; 0: none

    std::string bytes() const;
};

/// A Radiance HDR file of one row: four bytes (mantissas of r, g, b and the exponent plus 128) per pixel.
std::string tiny_hdr(const std::vector<std::uint8_t>& rgbe);

/// Baseline JPEG of a test pattern; grey for one channel, and without subsampling from `quality` (1 to 100) 91 on.
std::string tiny_jpeg(int width, int height, int channels, int quality);

}  // namespace treefarm::test
