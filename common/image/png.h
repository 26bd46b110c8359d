// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/image/image.h"

namespace treefarm {

/// An 8-bit sRGB PNG of linear colours times `exposure`, clamped to [0, 1]; NaN becomes black. Throws RunError.
std::vector<std::uint8_t> encode_png(const RgbImage& image, float exposure = 1.0f);

/// Writes the file of encode_png(), atomically. Throws RunError.
void write_png(const std::filesystem::path& path, const RgbImage& image, float exposure = 1.0f);

/// Whether 8- and 16-bit files hold sRGB-encoded colours or plain numbers (roughness, bump, mask).
enum class Encoding { srgb, linear };

/// Reads a PNG (8 or 16 bits) or JPEG as floats, 1 is the file's white: the channels Y, or R, G, B, each with A where
/// the file has one (A is never decoded as sRGB). Throws InputError that names the file: missing, another format,
/// damaged, too large.
Image read_ldr(const std::filesystem::path& path, Encoding encoding);

}  // namespace treefarm
