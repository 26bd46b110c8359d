// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "coordinator/input/images/pixels.h"

/// Interface to the stb libraries, for use within this module only.
namespace treefarm::stb {

/// Pixels of a BMP or TGA file. Empty, with the reason in `why`, if it cannot be decoded.
std::optional<Pixels> decode(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm::stb
