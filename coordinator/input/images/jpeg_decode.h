// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "coordinator/input/images/pixels.h"

namespace treefarm {

/// Size that a JPEG file claims; nothing, and `why`, if its header is damaged.
std::optional<ImageSize> jpeg_size(std::span<const std::uint8_t> bytes, std::string& why);

/// A JPEG file's pixels, by libjpeg-turbo: grey or RGB, inks as RGB without a profile. Nothing, and `why`, if it is
/// damaged or cut short.
std::optional<Pixels> decode_jpeg(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm
