// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/image/image.h"

namespace treefarm {

/// An 8-bit sRGB PNG of linear colours times `exposure`, clamped to [0, 1]; NaN becomes black. Throws RunError.
std::vector<std::uint8_t> encode_png(const RgbImage& image, float exposure = 1.0f);

/// Writes the file of encode_png() atomically. Throws RunError.
void write_png(const std::filesystem::path& path, const RgbImage& image, float exposure = 1.0f);

/// Meaning of 8- and 16-bit values: sRGB-encoded colours or plain numbers (roughness, bump, mask).
enum class Encoding { srgb, linear };

/// Reads a PNG (8 or 16 bits) or JPEG as floats with white at 1: the channels Y, or R, G, B, and A if the file has it
/// (never decoded as sRGB). Throws InputError with the file's name if it is missing, of another format, damaged, or too
/// large.
Image read_ldr(const std::filesystem::path& path, Encoding encoding);

}  // namespace treefarm
