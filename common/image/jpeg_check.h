// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace treefarm {

/// The fault of a JPEG file that stb's decoder would not survive or not notice: a Huffman table of more than 256 codes
/// (it writes past the table), or no end marker behind the scans (what is missing would be grey). Empty if there is
/// none.
const char* jpeg_fault(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
