// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "coordinator/input/images/pixels.h"

namespace treefarm {

/// Size that a PNG file claims in its first chunk; empty for other files.
std::optional<ImageSize> png_size(std::span<const std::uint8_t> bytes);

/// Pixels of a PNG file, by libpng: palettes are looked up, transparent colours become alpha, gamma and profiles are
/// not applied. Empty, with the reason in `why`, if it is damaged.
std::optional<Pixels> decode_png(std::span<const std::uint8_t> bytes, std::string& why);

/// Size that a JPEG file claims; empty, with the reason in `why`, if its header is damaged.
std::optional<ImageSize> jpeg_size(std::span<const std::uint8_t> bytes, std::string& why);

/// Pixels of a JPEG file, by libjpeg-turbo: grey or RGB; CMYK becomes RGB without a profile. Empty, with the reason in
/// `why`, if it is damaged or cut short.
std::optional<Pixels> decode_jpeg(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm
