#include "common/image/stored_image.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "common/base/error.h"
#include "common/image/exr.h"
#include "common/image/read_bytes.h"
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

/// The exponent of the chunk gAMA, or 0 where there is none or sRGB overrides it (PNG specification, 11.3.2).
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

StoredImage read_with_stb(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = read_bytes(path, kCure);
    const auto size = stb::image_size(bytes);
    if (!size) refuse(path, "is neither PNG, JPEG, OpenEXR nor Radiance HDR, or damaged", kCure);
    if (size->width > kMaxImageSide || size->height > kMaxImageSide ||
        static_cast<std::size_t>(size->width) * static_cast<std::size_t>(size->height) > kMaxImageValues / 4)
        refuse(path, "claims " + std::to_string(size->width) + " x " + std::to_string(size->height) + " pixels",
               "reduce its size, or check whether it is damaged");
    std::string why;
    auto pixels = stb::decode_as_stored(bytes, why);
    if (!pixels) refuse(path, "cannot be decoded (" + why + ")", "it is damaged or cut short; save it again");
    StoredImage image;
    image.width = pixels->width;
    image.height = pixels->height;
    image.channels = channel_names(pixels->channels);
    image.bytes = std::move(pixels->bytes);
    image.floats = std::move(pixels->floats);
    image.integers = !pixels->linear;
    constexpr std::array<std::uint8_t, 4> kPng = {0x89, 'P', 'N', 'G'};
    if (bytes.size() > 8 && std::equal(kPng.begin(), kPng.end(), bytes.begin())) image.gamma = png_gamma(bytes);
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
    return is_exr_file(path) ? read_from_exr(path) : read_with_stb(path);
}

}  // namespace treefarm
