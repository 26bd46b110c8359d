// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

enum class ImageFormat { png, jpeg, hdr, bmp, tga, netpbm };

/// The bytes of a PNG, JPEG, Radiance HDR, BMP, TGA, PGM, PPM or PFM file that are worth decoding.
struct EncodedImage {
    ImageFormat format = ImageFormat::png;
    int width = 0, height = 0;   ///< as the file claims, pixels
    std::size_t data_begin = 0;  ///< hdr: offset of the first pixel
    std::vector<std::uint8_t> bytes;
};

/// Reads such a file and holds the size that it claims against what is read at all (image.h) and against its length: no
/// decoder allocates for pixels that cannot be there. Throws InputError that names the file: missing, another format
/// (`cure` says what to give), too large, cut short.
EncodedImage read_encoded_image(const std::filesystem::path& path, const std::string& cure,
                                std::uint64_t most_pixels = ~0ull);

}  // namespace treefarm
