#include "common/image/stored_image.h"

#include <cstring>

#include "common/base/error.h"
#include "common/image/encoded_image.h"
#include "common/image/exr.h"
#include "common/image/hdr.h"
#include "common/image/stb.h"

namespace treefarm {
namespace {

constexpr const char* kCure = "give a PNG, JPEG, OpenEXR or Radiance HDR file";

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, const std::string& cure) {
    throw InputError(Location{path.string()}, what, cure);
}

std::uint32_t big_endian(const std::uint8_t* p) {
    return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | std::uint32_t{p[3]};
}

/// The exponent of the chunk gAMA, or 0 where there is none or the chunk sRGB overrides it, as in Mitsuba 0.6.
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

StoredImage read_encoded(const std::filesystem::path& path) {
    const EncodedImage file = read_encoded_image(path, kCure);
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
    } else if (auto pixels = stb::decode_as_stored(file.bytes, why)) {
        image.channels = channel_names(pixels->channels);
        image.bytes = std::move(pixels->bytes);
        image.floats = std::move(pixels->floats);
        image.integers = true;
        if (file.format == ImageFormat::png) image.gamma = png_gamma(file.bytes);
    }
    if (!why.empty()) refuse(path, "cannot be decoded (" + why + ")", "it is damaged or cut short; save it again");
    return image;
}

StoredImage read_from_exr(const std::filesystem::path& path) {
    const ExrImage file = read_exr(path, [](const std::string& name) {
        return name == "R" || name == "G" || name == "B" || name == "Y" || name == "A";
    });
    StoredImage image;
    image.width = file.image.width;
    image.height = file.image.height;
    const bool rgb = file.image.find("R") && file.image.find("G") && file.image.find("B");
    if (!rgb && !file.image.find("Y"))
        refuse(path, "has neither the channels R, G, B nor Y", "check which channels it has (exrheader)");
    image.channels = rgb ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
    if (file.image.find("A")) image.channels.emplace_back("A");
    const std::size_t count = image.channels.size();
    image.floats.resize(file.image.pixel_count() * count);
    for (std::size_t c = 0; c < count; ++c) {
        const auto values = file.image.channel(*file.image.find(image.channels[c]));
        for (std::size_t i = 0; i < values.size(); ++i)
            image.floats[i * count + c] = values[i];
    }
    return image;
}

}  // namespace

StoredImage read_stored_image(const std::filesystem::path& path) {
    return is_exr_file(path) ? read_from_exr(path) : read_encoded(path);
}

}  // namespace treefarm
