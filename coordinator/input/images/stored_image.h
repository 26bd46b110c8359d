// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// An image as its file stores it, for textures: integers stay encoded, so that whoever asked decides what they mean.
struct StoredImage {
    int width = 0, height = 0;          ///< pixels
    std::vector<std::string> channels;  ///< "Y" or "R", "G", "B", and perhaps "A"
    std::vector<std::uint8_t> bytes;    ///< 8-bit files: rows from the top, channels interleaved; otherwise empty
    std::vector<float> floats;          ///< the others; 16-bit files as 0 to 1
    bool integers = false;              ///< 8 or 16 bits: not linear unless the asker knows better
    double gamma = 0.0;                 ///< exponent that a PNG file says to decode its values with; 0: it does not
};

/// Reads PNG, JPEG, OpenEXR, Radiance HDR, BMP, TGA, PGM, PPM or PFM, told apart by their first bytes (TGA also by its
/// last ones, or its name). Throws InputError that names the file:
/// missing, another format, damaged, too large, no channels R, G, B or Y.
/// `most_pixels`: more are refused before anything is allocated for them.
StoredImage read_stored_image(const std::filesystem::path& path, std::uint64_t most_pixels = ~0ull);

}  // namespace treefarm
