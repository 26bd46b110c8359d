// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/bitmap_check.h"

#include <algorithm>
#include <string_view>

namespace treefarm {
namespace {

/// Integer of `count` bytes in little-endian order; the bytes must exist.
std::uint32_t little(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;)
        value = value << 8 | bytes[at + i];
    return value;
}

std::optional<ImageSize> refuse(std::string& why, const char* reason) {
    why = reason;
    return std::nullopt;
}

constexpr const char* kCut = "it is cut short";
constexpr const char* kMalformed = "its header is malformed";
constexpr std::int64_t kLongestSide = std::int64_t{1} << 24;

/// Whether the packets of a TGA file contain so many pixels.
bool holds_pixels(std::span<const std::uint8_t> packets, std::uint64_t pixels, std::size_t pixel_bytes) {
    std::size_t at = 0;
    while (pixels > 0) {
        if (at >= packets.size()) return false;
        const std::size_t count = (packets[at] & 0x7fu) + 1u;
        const std::size_t size = 1 + ((packets[at] & 0x80u) != 0 ? 1 : count) * pixel_bytes;
        if (size > packets.size() - at) return false;
        at += size;
        pixels -= std::min<std::uint64_t>(pixels, count);
    }
    return true;
}

}  // namespace

bool is_bmp(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 2 && bytes[0] == 'B' && bytes[1] == 'M';
}

bool is_tga(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view kEnd("TRUEVISION-XFILE.\0", 18);
    return bytes.size() >= kEnd.size() &&
           std::equal(kEnd.begin(), kEnd.end(), bytes.end() - static_cast<std::ptrdiff_t>(kEnd.size()),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

std::optional<ImageSize> check_bmp(std::span<const std::uint8_t> bytes, std::string& why) {
    if (bytes.size() < 30) return refuse(why, kCut);
    const std::uint32_t begin = little(bytes, 10, 4), header = little(bytes, 14, 4);
    const bool is_old = header == 12;
    if (!is_old && header != 40 && header != 56 && header != 108 && header != 124) return refuse(why, kMalformed);
    if (bytes.size() < 14 + std::size_t{header} || begin < 14 + header || begin > bytes.size())
        return refuse(why, kCut);
    const std::int64_t width = is_old ? little(bytes, 18, 2) : static_cast<std::int32_t>(little(bytes, 18, 4));
    // a negative height means rows from the top
    const std::int64_t signed_height = is_old ? little(bytes, 20, 2) : static_cast<std::int32_t>(little(bytes, 22, 4));
    const std::int64_t height = std::abs(signed_height);
    if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide) return refuse(why, kMalformed);
    const std::uint32_t bits = little(bytes, is_old ? 24 : 28, 2), packing = is_old ? 0 : little(bytes, 30, 4);
    if (packing != 0 && packing != 3) return refuse(why, "it is a compressed BMP, which is not read");
    if (bits != 1 && bits != 4 && bits != 8 && bits != 16 && bits != 24 && bits != 32)
        return refuse(why, "it is a BMP of an unknown depth");
    const std::uint64_t row_bits = static_cast<std::uint64_t>(width) * bits;
    const std::uint64_t padded = (row_bits + 31) / 32 * 4, last = (row_bits + 7) / 8;
    if (padded * static_cast<std::uint64_t>(height - 1) + last > bytes.size() - begin) return refuse(why, kCut);
    return ImageSize{static_cast<int>(width), static_cast<int>(height)};
}

std::optional<ImageSize> check_tga(std::span<const std::uint8_t> bytes, std::string& why) {
    if (bytes.size() < 18) return refuse(why, kCut);
    const std::uint32_t kind = bytes[2], bits = bytes[16];
    const bool packed = kind >= 9, has_palette = bytes[1] == 1;
    const std::uint32_t plain = packed ? kind - 8 : kind;
    if (bytes[1] > 1 || plain < 1 || plain > 3 || has_palette != (plain == 1)) return refuse(why, kMalformed);
    if (bits != 8 && bits != 15 && bits != 16 && bits != 24 && bits != 32) return refuse(why, kMalformed);
    if (plain == 1 && bits != 8 && bits != 16) return refuse(why, kMalformed);
    const std::uint32_t width = little(bytes, 12, 2), height = little(bytes, 14, 2);
    if (width == 0 || height == 0) return refuse(why, kMalformed);
    const std::uint32_t colours = little(bytes, 5, 2), colour_bits = bytes[7];
    if (has_palette &&
        (colours == 0 || (colour_bits != 15 && colour_bits != 16 && colour_bits != 24 && colour_bits != 32)))
        return refuse(why, kMalformed);
    const std::size_t begin =
        18 + std::size_t{bytes[0]} + (has_palette ? (little(bytes, 3, 2) + colours) * ((colour_bits + 7) / 8) : 0);
    if (begin > bytes.size()) return refuse(why, kCut);
    const std::uint64_t pixels = std::uint64_t{width} * height;
    const std::size_t pixel_bytes = (bits + 7) / 8;
    const bool fits =
        packed ? holds_pixels(bytes.subspan(begin), pixels, pixel_bytes) : pixels * pixel_bytes <= bytes.size() - begin;
    if (!fits) return refuse(why, kCut);
    return ImageSize{static_cast<int>(width), static_cast<int>(height)};
}

}  // namespace treefarm
