// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

enum class ImageFormat { png, jpeg, hdr, bmp, tga, netpbm };

/// Bytes of a PNG, JPEG, Radiance HDR, BMP, TGA, PGM, PPM or PFM file that may be decoded.
struct EncodedImage {
    ImageFormat format = ImageFormat::png;
    int width = 0, height = 0;   ///< claimed size, pixels
    std::size_t data_begin = 0;  ///< hdr: offset of the first pixel
    std::vector<std::uint8_t> bytes;
};

/// Reads an image file (formats: EncodedImage) and checks its claimed size against the limits (image.h) and the file's
/// length, so that no decoder allocates memory for pixels that cannot exist. Throws InputError with the file's name if
/// it is missing, of another format (`cure`: what to give instead), too large, or cut short.
EncodedImage read_encoded_image(const std::filesystem::path& path, const std::string& cure,
                                std::uint64_t most_pixels = ~0ull);

}  // namespace treefarm
