// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "coordinator/input/images/pixels.h"

namespace treefarm {

/// The bytes begin like a BMP file.
bool is_bmp(std::span<const std::uint8_t> bytes);

/// The bytes end like a TGA file of its version 2. Files of version 1 are known by their name only.
bool is_tga(std::span<const std::uint8_t> bytes);

/// Size of a BMP or TGA file. Nothing, and `why`, where its header is malformed, names a kind that is not read, or
/// claims more pixels than there are in the file.
std::optional<ImageSize> check_bmp(std::span<const std::uint8_t> bytes, std::string& why);
std::optional<ImageSize> check_tga(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm
