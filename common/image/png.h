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

}  // namespace treefarm
