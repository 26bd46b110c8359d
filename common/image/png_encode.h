// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace treefarm {

/// PNG file of 8-bit RGB or RGBA values (3 or 4 channels), row by row; empty if size and data disagree or memory runs
/// out. Optimised for speed, not size; stb_image_write is slower, and its files are larger (bench/log/speed.md, "how
/// long does a PNG take to write").
std::vector<std::uint8_t> encode_png(int width, int height, int channels, std::span<const std::uint8_t> bytes);

}  // namespace treefarm
