// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tiny_images.h"

#include <zlib.h>

#include <cmath>

// stb has the only JPEG writer available; its warnings are not ours.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace treefarm::test {
namespace {

std::string big_endian(std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
        text += static_cast<char>(value >> shift & 0xff);
    return text;
}

std::string chunk(const std::string& name, const std::string& data) {
    const std::string summed = name + data;
    const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(summed.data()), summed.size());
    return big_endian(static_cast<std::uint32_t>(data.size())) + summed + big_endian(static_cast<std::uint32_t>(sum));
}

}  // namespace

std::string TinyPng::bytes() const {
    constexpr char kKinds[] = {0, 0, 4, 2, 6};
    std::string header = big_endian(static_cast<std::uint32_t>(width)) + big_endian(static_cast<std::uint32_t>(height));
    header += static_cast<char>(bits);
    header += kKinds[channels];
    header += std::string(3, '\0');
    std::string rows;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i % static_cast<std::size_t>(width * channels) == 0) rows += '\0';
        if (bits == 16) rows += static_cast<char>(values[i] >> 8);
        rows += static_cast<char>(values[i] & 0xff);
    }
    // One uncompressed deflate block, between zlib's header and its checksum.
    const auto size = static_cast<std::uint32_t>(rows.size());
    std::string data = "\x78\x01\x01";
    for (const std::uint32_t word : {size, ~size})
        for (const int shift : {0, 8})
            data += static_cast<char>(word >> shift & 0xff);
    const auto sum = adler32_z(1, reinterpret_cast<const Bytef*>(rows.data()), rows.size());
    data += rows + big_endian(static_cast<std::uint32_t>(sum));
    std::string file = "\x89PNG\r\n\x1a\n" + chunk("IHDR", header);
    if (gamma > 0.0) file += chunk("gAMA", big_endian(static_cast<std::uint32_t>(std::lround(gamma * 1e5))));
    return file + chunk("IDAT", data) + chunk("IEND", "");
}

std::string tiny_hdr(const std::vector<std::uint8_t>& rgbe) {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X " + std::to_string(rgbe.size() / 4) + "\n";
    file.append(rgbe.begin(), rgbe.end());
    return file;
}

std::string tiny_jpeg(int width, int height, int channels, int quality) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < width * height * channels; ++i)
        pixels.push_back(static_cast<std::uint8_t>(i * 37 + i / 7));
    std::string file;
    const auto append = [](void* text, void* data, int size) {
        static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    stbi_write_jpg_to_func(append, &file, width, height, channels, pixels.data(), quality);
    return file;
}

}  // namespace treefarm::test
