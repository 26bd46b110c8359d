// SPDX-License-Identifier: Apache-2.0
#include "common/image/exr_header.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/image/image.h"

// Layout from "OpenEXR File Layout" (openexr.com), checked against files written by OpenEXR: magic, version and flags;
// attributes, each with name, type, size and value; an empty name ends a header, an empty header ends the headers of a
// multi-part file; then one offset of eight bytes per chunk of pixels.

namespace treefarm {
namespace {

constexpr std::uint64_t kSmallestChunk = 8 + 8 + 1;  ///< offset, header and one byte
constexpr std::uint64_t kLooseTileBytes = std::uint64_t{16} << 20;
constexpr std::uint32_t kMultiPartFlag = 0x1000;

/// Values of a header that determine the memory for decoding.
struct Claims {
    std::uint64_t width = 0, height = 0;
    std::uint64_t pixel_bytes = 0;  ///< bytes of all channels
    std::uint8_t compression = 0;
    std::optional<std::uint64_t> tile_width, tile_height;
};

/// Scan lines per chunk, by the file's number of the compression.
std::uint64_t lines_per_chunk(std::uint8_t compression) {
    constexpr std::uint64_t kLines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return compression < std::size(kLines) ? kLines[compression] : 256;
}

/// Upper bound of the pixel bytes that a byte of the file encodes: deflate packs at most 1032 into one (a match of 258
/// bytes takes at least two bits). DWA (8, 9) deflates the rest of a block of 64 floats, at least four bytes.
std::uint64_t most_expansion(std::uint8_t compression) {
    return compression < 8 ? 2 * 1032 : 64 * 1032;
}

class HeaderWalk {
  public:
    explicit HeaderWalk(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
        std::error_code error;
        size_ = std::filesystem::file_size(path, error);
        if (error) refuse("cannot be read", "check its permissions");
    }

    void check() {
        take(4);
        const bool multi_part = (number(take(4), 0) & kMultiPartFlag) != 0;
        while (walk_header() && multi_part) {
        }
    }

  private:
    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError(Location{path_.string()}, what, cure);
    }
    [[noreturn]] void refuse_cut() const { refuse("its header is damaged or cut short", "write or copy it again"); }
    [[noreturn]] void refuse_claim(const std::string& what) const {
        refuse("claims " + what + ", which its " + std::to_string(size_) + " bytes cannot hold",
               "it is damaged or cut short: write or copy it again");
    }

    std::string take(std::uint64_t count) {
        if (count > size_ - at_) refuse_cut();
        std::string bytes(static_cast<std::size_t>(count), '\0');
        file_.read(bytes.data(), static_cast<std::streamsize>(count));
        if (!file_) refuse_cut();
        at_ += count;
        return bytes;
    }

    void skip(std::uint64_t count) {
        if (count > size_ - at_) refuse_cut();
        file_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
        at_ += count;
    }

    std::string take_word() {
        constexpr std::size_t kLongest = 256;
        std::string word;
        for (char c = take(1)[0]; c != '\0'; c = take(1)[0]) {
            word += c;
            if (word.size() > kLongest) refuse_cut();
        }
        return word;
    }

    static std::uint32_t number(std::string_view bytes, std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value |= std::uint32_t{static_cast<std::uint8_t>(bytes[at + i])} << (8 * i);
        return value;
    }

    /// Walks over a part's header; false for the empty one after the last part.
    bool walk_header() {
        Claims claims;
        bool any = false;
        for (std::string name = take_word(); !name.empty(); name = take_word(), any = true) {
            const std::string type = take_word();
            const std::uint32_t size = number(take(4), 0);
            const std::optional<std::uint32_t> fixed = fixed_size(type);
            if (fixed ? *fixed != size : size > size_ - at_) refuse_cut();
            if (!fixed && !is_parsed(type)) {
                skip(size);
                continue;
            }
            const std::string value = take(size);
            if (type == "chlist") claims.pixel_bytes = bytes_of_channels(value);
            if (type == "preview") check_preview(value);
            if (type == "stringvector") check_strings(value);
            if (name == "compression" && type == "compression")
                claims.compression = static_cast<std::uint8_t>(value[0]);
            if (name == "dataWindow" && type == "box2i") {
                claims.width = side(value, 0);
                claims.height = side(value, 4);
            }
            if (name == "tiles" && type == "tiledesc") {
                claims.tile_width = number(value, 0);
                claims.tile_height = number(value, 4);
            }
        }
        if (any) check(claims);
        return any;
    }

    /// Size in bytes of types that OpenEXR reads with a fixed size, whatever the attribute's size says.
    static std::optional<std::uint32_t> fixed_size(std::string_view type) {
        static constexpr std::pair<std::string_view, std::uint32_t> kSizes[] = {{"box2f", 16},
                                                                                {"box2i", 16},
                                                                                {"chromaticities", 32},
                                                                                {"compression", 1},
                                                                                {"deepImageState", 1},
                                                                                {"double", 8},
                                                                                {"envmap", 1},
                                                                                {"float", 4},
                                                                                {"int", 4},
                                                                                {"keycode", 28},
                                                                                {"lineOrder", 1},
                                                                                {"m33d", 72},
                                                                                {"m33f", 36},
                                                                                {"m44d", 128},
                                                                                {"m44f", 64},
                                                                                {"rational", 8},
                                                                                {"tiledesc", 9},
                                                                                {"timecode", 8},
                                                                                {"v2d", 16},
                                                                                {"v2f", 8},
                                                                                {"v2i", 8},
                                                                                {"v3d", 24},
                                                                                {"v3f", 12},
                                                                                {"v3i", 12}};
        for (const auto& [name, size] : kSizes)
            if (type == name) return size;
        return std::nullopt;
    }

    /// Whether an attribute's type contains lengths.
    static bool is_parsed(std::string_view type) {
        return type == "chlist" || type == "preview" || type == "stringvector";
    }

    /// Pixels from a box's lower to its upper coordinate. `axis`: byte offset of the lower one, 0 for x, 4 for y.
    static std::uint64_t side(std::string_view box, std::size_t axis) {
        const auto from = static_cast<std::int32_t>(number(box, axis)),
                   to = static_cast<std::int32_t>(number(box, axis + 8));
        return to < from ? 0 : static_cast<std::uint64_t>(std::int64_t{to} - from + 1);
    }

    /// Bytes per pixel of all channels. Each channel is a name and sixteen bytes that begin with its type: 1 is half,
    /// the others have four bytes.
    std::uint64_t bytes_of_channels(std::string_view list) const {
        std::uint64_t bytes = 0;
        while (!list.empty() && list[0] != '\0') {
            const std::size_t end = list.find('\0');
            if (end == std::string_view::npos || list.size() - end < 17) refuse_cut();
            bytes += number(list, end + 1) == 1 ? 2 : 4;
            list.remove_prefix(end + 17);
        }
        if (list.size() != 1) refuse_cut();
        return bytes;
    }

    /// Checks a preview image: width, height and four bytes per pixel.
    void check_preview(std::string_view value) const {
        if (value.size() < 8) refuse_cut();
        const std::uint64_t pixels = std::uint64_t{number(value, 0)} * number(value, 4);
        if (pixels > value.size() || value.size() != 8 + 4 * pixels) refuse_cut();
    }

    void check_strings(std::string_view value) const {
        while (!value.empty()) {
            if (value.size() < 4 || number(value, 0) > value.size() - 4) refuse_cut();
            value.remove_prefix(4 + number(value, 0));
        }
    }

    void check(const Claims& claims) const {
        const std::string size = std::to_string(claims.width) + " x " + std::to_string(claims.height) + " pixels";
        if (claims.width > kMaxImageSide || claims.height > kMaxImageSide)
            refuse("claims " + size + ", more than " + std::to_string(kMaxImageSide) + " on a side",
                   "crop it, or check whether the file is damaged");
        const std::uint64_t most = size_ * most_expansion(claims.compression);
        if (claims.width * claims.height > most / std::max<std::uint64_t>(claims.pixel_bytes, 1)) refuse_claim(size);
        std::uint64_t chunks = 0;
        if (claims.tile_width && claims.tile_height) {
            const std::uint64_t w = *claims.tile_width, h = *claims.tile_height;
            if (w == 0 || h == 0 || w > kMaxImageSide || h > kMaxImageSide)
                refuse("claims tiles of " + std::to_string(w) + " x " + std::to_string(h) + " pixels",
                       "check whether the file is damaged");
            chunks = ((claims.width + w - 1) / w) * ((claims.height + h - 1) / h);
            if (w * h > std::max(most, kLooseTileBytes) / std::max<std::uint64_t>(claims.pixel_bytes, 1))
                refuse_claim("tiles of " + std::to_string(w) + " x " + std::to_string(h) + " pixels");
        } else {
            const std::uint64_t lines = lines_per_chunk(claims.compression);
            chunks = (claims.height + lines - 1) / lines;
        }
        if (chunks > size_ / kSmallestChunk) refuse_claim(std::to_string(chunks) + " chunks of pixels");
    }

    std::filesystem::path path_;
    std::ifstream file_;
    std::uint64_t size_ = 0, at_ = 0;
};

}  // namespace

void check_exr_header(const std::filesystem::path& path) {
    HeaderWalk(path).check();
}

}  // namespace treefarm
