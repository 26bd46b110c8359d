#include "common/image/png.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/image/atomic_file.h"
#include "common/image/encoded_image.h"
#include "common/image/srgb.h"
#include "common/image/stb.h"

namespace treefarm {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, const std::string& cure) {
    throw InputError(Location{path.string()}, what, cure);
}

std::uint8_t to_byte(float linear) {
    const float clamped = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;  // NaN fails the comparison
    return static_cast<std::uint8_t>(std::lround(srgb_encode(clamped) * 255.0f));
}

}  // namespace

void write_png(const std::filesystem::path& path, const RgbImage& image, float exposure) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.pixels.size() * 3);
    for (const Rgb& pixel : image.pixels)
        for (int c = 0; c < 3; ++c)
            rgb.push_back(to_byte(pixel[c] * exposure));
    const std::vector<std::uint8_t> png = stb::encode_png(image.width, image.height, rgb);
    if (png.empty())
        throw RunError(path.string() + ": an image of " + std::to_string(image.width) + " x " +
                       std::to_string(image.height) + " pixels cannot be encoded as PNG");
    write_file_atomically(path, png);
}

Image read_ldr(const std::filesystem::path& path, Encoding encoding) {
    const EncodedImage file = read_encoded_image(path, "give a PNG or JPEG file");
    if (file.format == ImageFormat::hdr) refuse(path, "is neither PNG nor JPEG", "convert it to PNG");
    std::string why;
    const auto decoded = stb::decode(file.bytes, why);
    if (!decoded) refuse(path, "cannot be decoded (" + why + ")", "it is damaged or cut short; save it again");

    const int channels = decoded->channels;
    const bool grey = channels < 3, alpha = channels % 2 == 0;
    Image image{decoded->width,
                decoded->height,
                grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"},
                {}};
    if (alpha) image.channel_names.emplace_back("A");
    image.data.resize(image.channel_names.size() * image.pixel_count());
    for (int c = 0; c < channels; ++c) {
        const bool decode = encoding == Encoding::srgb && !(alpha && c == channels - 1);
        const auto values = image.channel(static_cast<std::size_t>(c));
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t at = i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c);
            const float value = static_cast<float>(decoded->values[at]) / 65535.0f;
            values[i] = decode ? srgb_decode(value) : value;
        }
    }
    return image;
}

}  // namespace treefarm
