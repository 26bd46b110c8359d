#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The only door to the stb libraries; png.cpp is its only user.
namespace treefarm::stb {

struct Size {
    int width = 0, height = 0;
};

/// Row by row, channels interleaved, 16 bits each; 8-bit files are widened exactly (v x 257).
struct Decoded {
    int width = 0, height = 0, channels = 0;
    std::vector<std::uint16_t> values;
};

/// Size that a PNG or JPEG claims; nothing for other formats.
std::optional<Size> image_size(std::span<const std::uint8_t> bytes);

/// Nothing, and `why`, if it cannot be decoded.
std::optional<Decoded> decode(std::span<const std::uint8_t> bytes, std::string& why);

/// A PNG of 8-bit RGB triples, row by row; empty if the size and the data do not agree or memory runs out.
std::vector<std::uint8_t> encode_png(int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace treefarm::stb
