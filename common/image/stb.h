// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The only door to the stb libraries, used within this room.
namespace treefarm::stb {

struct Size {
    int width = 0, height = 0;
};

/// Row by row, channels interleaved, 16 bits each; 8-bit files are widened exactly (v x 257).
struct Decoded {
    int width = 0, height = 0, channels = 0;
    std::vector<std::uint16_t> values;
};

/// Pixels in the file's own precision.
struct Stored {
    int width = 0, height = 0, channels = 0;
    std::vector<std::uint8_t> bytes;  ///< 8-bit files
    std::vector<float> floats;        ///< 16-bit files as 0 to 1
};

/// Size that a PNG or JPEG file claims; nothing for other formats.
std::optional<Size> image_size(std::span<const std::uint8_t> bytes);

/// The decoded file; nothing, and `why`, if it cannot be decoded.
std::optional<Decoded> decode(std::span<const std::uint8_t> bytes, std::string& why);

std::optional<Stored> decode_as_stored(std::span<const std::uint8_t> bytes, std::string& why);

}  // namespace treefarm::stb
