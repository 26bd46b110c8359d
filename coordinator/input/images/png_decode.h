// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "coordinator/input/images/pixels.h"

namespace treefarm {

/// Size that a PNG file claims in its first chunk; nothing for other files.
std::optional<ImageSize> png_size(std::span<const std::uint8_t> bytes);

/// A PNG file's pixels, by libpng: palettes looked up, transparent colours as alpha, gamma and profiles left alone.
/// Nothing, and `why`, if it is damaged.
std::optional<Pixels> decode_png(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm
