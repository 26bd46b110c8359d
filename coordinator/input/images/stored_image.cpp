// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/stored_image.h"

#include <algorithm>
#include <cstring>

#include "common/base/error.h"
#include "common/image/exr.h"
#include "coordinator/input/images/color_channels.h"
#include "coordinator/input/images/decoders.h"
#include "coordinator/input/images/encoded_image.h"
#include "coordinator/input/images/hdr.h"
#include "coordinator/input/images/netpbm.h"
#include "coordinator/input/images/stb.h"

namespace treefarm {
namespace {

constexpr const char* kCure = "give a PNG, JPEG, OpenEXR, Radiance HDR, BMP, TGA, PPM or PFM file";

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, const std::string& cure) {
    throw InputError(Location{path.string()}, what, cure);
}

std::uint32_t big_endian(const std::uint8_t* p) {
    return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | std::uint32_t{p[3]};
}

/// Exponent of the chunk gAMA; 0 if there is none, or if the chunk sRGB overrides it, as in Mitsuba 0.6.
double png_gamma(std::span<const std::uint8_t> bytes) {
    double gamma = 0.0;
    std::size_t at = 8;
    while (at + 12 <= bytes.size()) {
        const std::size_t length = big_endian(&bytes[at]);
        const auto is = [&](const char* name) { return std::memcmp(&bytes[at + 4], name, 4) == 0; };
        if (is("IDAT") || length > bytes.size() - at - 12) break;
        if (is("sRGB")) return 0.0;
        if (is("gAMA") && length == 4 && big_endian(&bytes[at + 8]) > 0) gamma = 1e5 / big_endian(&bytes[at + 8]);
        at += length + 12;
    }
    return gamma;
}

std::vector<std::string> channel_names(int count) {
    std::vector<std::string> names =
        count < 3 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    if (count % 2 == 0) names.emplace_back("A");
    return names;
}

std::optional<Pixels> decode_integers(const EncodedImage& file, std::string& why) {
    if (file.format == ImageFormat::png) return decode_png(file.bytes, why);
    if (file.format == ImageFormat::jpeg) return decode_jpeg(file.bytes, why);
    return stb::decode(file.bytes, why);
}

StoredImage read_encoded(const std::filesystem::path& path, std::uint64_t most_pixels) {
    const EncodedImage file = read_encoded_image(path, kCure, most_pixels);
    StoredImage image;
    image.width = file.width;
    image.height = file.height;
    std::string why;
    if (file.format == ImageFormat::hdr) {
        auto floats = decode_hdr(file.bytes, {file.width, file.height, file.data_begin}, why);
        if (floats) {
            image.channels = channel_names(3);
            image.floats = std::move(*floats);
        }
    } else if (file.format == ImageFormat::netpbm) {
        if (const auto header = read_netpbm_header(file.bytes, why)) {
            image.channels = channel_names(header->channels);
            image.integers = !header->floats;
            if (header->floats || header->max_value > 255)
                image.floats = netpbm_floats(file.bytes, *header);
            else
                image.bytes = netpbm_bytes(file.bytes, *header);
        }
    } else if (auto pixels = decode_integers(file, why)) {
        image.channels = channel_names(pixels->channels);
        image.bytes = std::move(pixels->bytes);
        image.floats = std::move(pixels->floats);
        image.integers = true;
        if (file.format == ImageFormat::png) image.gamma = png_gamma(file.bytes);
    }
    const bool is_whole = why == kOldHdrRuns;
    if (!why.empty())
        refuse(path, "cannot be decoded (" + why + ")",
               is_whole ? "save it again with a program of today" : "it is damaged or cut short; save it again");
    return image;
}

StoredImage read_from_exr(const std::filesystem::path& path, std::uint64_t most_pixels) {
    const std::vector<std::string> chosen = choose_color_channels(path, exr_channel_names(path));
    const ExrImage file = read_exr(
        path, [&](const std::string& name) { return std::find(chosen.begin(), chosen.end(), name) != chosen.end(); },
        most_pixels);
    StoredImage image;
    image.width = file.image.width;
    image.height = file.image.height;
    image.channels = channel_names(static_cast<int>(chosen.size()));
    const std::size_t count = chosen.size();
    image.floats.resize(file.image.pixel_count() * count);
    for (std::size_t c = 0; c < count; ++c) {
        const auto values = file.image.channel(*file.image.find(chosen[c]));
        for (std::size_t i = 0; i < values.size(); ++i)
            image.floats[i * count + c] = values[i];
    }
    return image;
}

}  // namespace

StoredImage read_stored_image(const std::filesystem::path& path, std::uint64_t most_pixels) {
    return is_exr_file(path) ? read_from_exr(path, most_pixels) : read_encoded(path, most_pixels);
}

}  // namespace treefarm
