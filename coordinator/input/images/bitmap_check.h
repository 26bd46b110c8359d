// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "coordinator/input/images/pixels.h"

namespace treefarm {

/// Whether the bytes begin like a BMP file.
bool is_bmp(std::span<const std::uint8_t> bytes);

/// Whether the bytes end like a TGA file of version 2. Files of version 1 are known by their name only.
bool is_tga(std::span<const std::uint8_t> bytes);

/// Size of a BMP or TGA file. Empty, with the reason in `why`, if the header is malformed, names an unsupported kind,
/// or claims more pixels than the file contains.
std::optional<ImageSize> check_bmp(std::span<const std::uint8_t> bytes, std::string& why);
std::optional<ImageSize> check_tga(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm
