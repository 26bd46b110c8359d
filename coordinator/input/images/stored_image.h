// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// An image as stored in a file, for textures: integers stay encoded, so that the caller decides on their meaning.
struct StoredImage {
    int width = 0, height = 0;          ///< pixels
    std::vector<std::string> channels;  ///< "Y" or "R", "G", "B", and perhaps "A"
    std::vector<std::uint8_t> bytes;    ///< 8-bit files: rows from the top, channels interleaved; otherwise empty
    std::vector<float> floats;          ///< other files; 16-bit values as 0 to 1
    bool integers = false;              ///< 8 or 16 bits: not linear unless the caller knows better
    double gamma = 0.0;                 ///< decoding exponent given by a PNG file; 0: none
};

/// Reads PNG, JPEG, OpenEXR, Radiance HDR, BMP, TGA, PGM, PPM or PFM, recognised by the first bytes (TGA also by its
/// last ones, or its name). Throws InputError with the file's name if it is missing, of another format, damaged,
/// without channels R, G, B or Y, or too large (more than `most_pixels`: before anything is allocated).
StoredImage read_stored_image(const std::filesystem::path& path, std::uint64_t most_pixels = ~0ull);

}  // namespace treefarm
