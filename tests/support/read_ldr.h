// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/image/image.h"

namespace treefarm {

/// Encoding of 8- and 16-bit files: sRGB colours, or linear numbers (roughness, bump, mask).
enum class Encoding { srgb, linear };

/// Reads a PNG (8 or 16 bits) or JPEG as floats, with 1 for the file's white: the channels Y, or R, G, B, and A if the
/// file has it (A is never decoded as sRGB). Throws InputError, which names the file, if it is missing, damaged, too
/// large, or of another format.
Image read_ldr(const std::filesystem::path& path, Encoding encoding);

}  // namespace treefarm
