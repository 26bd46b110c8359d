// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/encoded_image.h"

#include <algorithm>
#include <array>
#include <span>

#include "common/base/error.h"
#include "common/base/files/read_bytes.h"
#include "common/image/image.h"
#include "coordinator/input/images/bitmap_check.h"
#include "coordinator/input/images/decoders.h"
#include "coordinator/input/images/hdr.h"
#include "coordinator/input/images/lfs_pointer.h"
#include "coordinator/input/images/netpbm.h"

namespace treefarm {
namespace {

constexpr std::array<std::uint8_t, 2> kJpeg = {0xff, 0xd8};
constexpr std::array<std::uint8_t, 4> kPng = {0x89, 'P', 'N', 'G'};

template <std::size_t kSize>
bool begins_with(std::span<const std::uint8_t> bytes, const std::array<std::uint8_t, kSize>& magic) {
    return bytes.size() >= kSize && std::equal(magic.begin(), magic.end(), bytes.begin());
}

/// The format if it is Netpbm, BMP or TGA, whose files are checked for missing pixels; empty for other formats.
std::optional<ImageFormat> plain_format(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
    if (is_netpbm(bytes)) return ImageFormat::netpbm;
    if (is_bmp(bytes)) return ImageFormat::bmp;
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return static_cast<char>('A' <= c && c <= 'Z' ? c - 'A' + 'a' : c); });
    const bool is_other = begins_with(bytes, kPng) || begins_with(bytes, kJpeg) || is_hdr(bytes);
    if (is_tga(bytes) || (extension == ".tga" && !is_other)) return ImageFormat::tga;
    return std::nullopt;
}

/// Checks that no pixel data of a Netpbm, BMP or TGA file are missing, and sets the size.
void read_plain_header(EncodedImage& image, std::string& why) {
    if (image.format == ImageFormat::netpbm) {
        if (const auto header = read_netpbm_header(image.bytes, why)) {
            image.width = header->width;
            image.height = header->height;
        }
    } else if (const auto size =
                   image.format == ImageFormat::bmp ? check_bmp(image.bytes, why) : check_tga(image.bytes, why)) {
        image.width = size->width;
        image.height = size->height;
    }
}

/// Sets format and claimed size from the header.
void read_header(EncodedImage& image, const std::filesystem::path& path, std::string& why) {
    if (const auto format = plain_format(image.bytes, path)) {
        image.format = *format;
        read_plain_header(image, why);
    } else if (is_hdr(image.bytes)) {
        image.format = ImageFormat::hdr;
        if (const auto header = read_hdr_header(image.bytes, why)) {
            image.width = header->width;
            image.height = header->height;
            image.data_begin = header->data_begin;
        }
    } else if (begins_with(image.bytes, kJpeg)) {
        image.format = ImageFormat::jpeg;
        if (const auto size = jpeg_size(image.bytes, why)) {
            image.width = size->width;
            image.height = size->height;
        }
    } else if (const auto size = png_size(image.bytes); size && size->width > 0 && size->height > 0) {
        image.format = ImageFormat::png;
        image.width = size->width;
        image.height = size->height;
    } else {
        why = "is neither PNG nor JPEG nor Radiance HDR nor OpenEXR nor BMP, TGA, PPM or PFM, or damaged";
    }
}

/// Upper bound of the number of pixels that a byte of the file encodes.
std::size_t most_pixels_per_byte(ImageFormat format) {
    switch (format) {
        case ImageFormat::png:
            return 1032 *
                   8;  // deflate: a match of 258 bytes takes at least two bits; a byte holds eight pixels of one bit
        case ImageFormat::jpeg:
            return 1024;  // a block of 8 x 8 values takes at least one bit, and stands for at most 128 pixels on
                          // average over the planes
        case ImageFormat::tga:
            return 128;  // a packet of two bytes
        case ImageFormat::bmp:
        case ImageFormat::netpbm:
            return 8;
        case ImageFormat::hdr:
            break;
    }
    return 16;  // a run of at most 127 takes two bytes in each of four planes
}

/// Whether a chunk of a PNG file extends beyond the file's end, or the last chunk is missing.
bool is_cut_png(std::span<const std::uint8_t> bytes) {
    constexpr std::array<std::uint8_t, 4> kEnd = {'I', 'E', 'N', 'D'};
    std::size_t at = 8;
    while (at + 8 <= bytes.size()) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i)
            length = length << 8 | bytes[at + i];
        if (length > bytes.size() - at - 8) return true;
        if (std::equal(kEnd.begin(), kEnd.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4)) return false;
        at += length + 12;
    }
    return true;
}

}  // namespace

EncodedImage read_encoded_image(const std::filesystem::path& path, const std::string& cure, std::uint64_t most_pixels) {
    const auto refuse = [&](const std::string& what, const std::string& advice) {
        throw InputError(Location{path.string()}, what, advice);
    };
    EncodedImage image;
    image.bytes = read_bytes(path, cure);
    const std::size_t first = std::min<std::size_t>(image.bytes.size(), 64);
    if (is_lfs_pointer({reinterpret_cast<const char*>(image.bytes.data()), first})) refuse(kLfsPointer, kLfsCure);
    std::string why;
    const std::string again = "it is damaged or cut short; save it again";
    read_header(image, path, why);
    const bool is_known = image.format != ImageFormat::png;  // PNG also stands for unknown formats
    if (!why.empty()) refuse(is_known ? "cannot be decoded (" + why + ")" : why, is_known ? again : cure);
    const std::string claim =
        "claims " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels";
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (image.width > kMaxImageSide || image.height > kMaxImageSide ||
        pixels > std::min<std::uint64_t>(most_pixels, kMaxImageValues / 4))
        refuse(claim, "reduce its size, or check whether it is damaged");
    if (pixels / most_pixels_per_byte(image.format) > image.bytes.size())
        refuse(claim + ", which its " + std::to_string(image.bytes.size()) + " bytes cannot hold", again);
    constexpr std::size_t kLarge = std::size_t{1} << 26, kMostPacking = 100;
    if (pixels > kLarge && pixels / kMostPacking > image.bytes.size())
        refuse(claim + " in " + std::to_string(image.bytes.size()) + " bytes: all but empty, and slow to read",
               "reduce its size");
    if (image.format == ImageFormat::png && is_cut_png(image.bytes))
        refuse("cannot be decoded (it is cut short)", again);
    return image;
}

}  // namespace treefarm
