// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "common/image/image.h"

namespace treefarm {

/// An 8-bit sRGB PNG of linear colours times `exposure`, clamped to [0, 1]; NaN becomes black. With `alpha`, one for
/// each pixel, it is RGBA, and the colours should be straight (straight_colours()). Throws RunError.
std::vector<std::uint8_t> encode_png(const RgbImage& image, float exposure = 1.0f, std::span<const float> alpha = {});

/// Writes the file of encode_png() atomically. Throws RunError.
void write_png(const std::filesystem::path& path, const RgbImage& image, float exposure = 1.0f);

}  // namespace treefarm
