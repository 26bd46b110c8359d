// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/image/image.h"

namespace treefarm {

/// Whether 8- and 16-bit files hold sRGB-encoded colours or plain numbers (roughness, bump, mask).
enum class Encoding { srgb, linear };

/// Reads a PNG (8 or 16 bits) or JPEG as floats, 1 is the file's white: the channels Y, or R, G, B, each with A where
/// the file has one (A is never decoded as sRGB). Throws InputError that names the file: missing, another format,
/// damaged, too large.
Image read_ldr(const std::filesystem::path& path, Encoding encoding);

}  // namespace treefarm
