// SPDX-License-Identifier: Apache-2.0
#include "tests/support/read_ldr.h"

#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/image/srgb.h"
#include "coordinator/input/images/decoders.h"
#include "coordinator/input/images/encoded_image.h"

namespace treefarm {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, const std::string& cure) {
    throw InputError(Location{path.string()}, what, cure);
}

}  // namespace

Image read_ldr(const std::filesystem::path& path, Encoding encoding) {
    const EncodedImage file = read_encoded_image(path, "give a PNG or JPEG file");
    if (file.format != ImageFormat::png && file.format != ImageFormat::jpeg)
        refuse(path, "is neither PNG nor JPEG", "convert it to PNG");
    std::string why;
    const auto decoded = file.format == ImageFormat::png ? decode_png(file.bytes, why) : decode_jpeg(file.bytes, why);
    if (!decoded) refuse(path, "cannot be decoded (" + why + ")", "it is damaged or cut short; save it again");

    const auto channels = static_cast<std::size_t>(decoded->channels);
    const bool grey = channels < 3, alpha = channels % 2 == 0;
    Image image{decoded->width,
                decoded->height,
                grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"},
                {}};
    if (alpha) image.channel_names.emplace_back("A");
    image.data.resize(image.channel_names.size() * image.pixel_count());
    for (std::size_t c = 0; c < channels; ++c) {
        const bool decode = encoding == Encoding::srgb && !(alpha && c == channels - 1);
        const auto values = image.channel(c);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t at = i * channels + c;
            const float value =
                decoded->floats.empty() ? static_cast<float>(decoded->bytes[at]) / 255.0f : decoded->floats[at];
            values[i] = decode ? srgb_decode(value) : value;
        }
    }
    return image;
}

}  // namespace treefarm
