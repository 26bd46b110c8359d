// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/result_image.h"

#include <algorithm>
#include <limits>

#include "common/image/png.h"

namespace treefarm {

namespace {

void add_layer(Image& image, const std::string& layer, const std::vector<Rgb64>& values) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const char* const components[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const std::span<float> channel = image.add_channel(channel_name(layer, components[c]));
        for (std::size_t p = 0; p < values.size(); ++p)
            channel[p] = static_cast<float>(std::min(values[p][c], kMost));  // a variance may be larger
    }
}

}  // namespace

RgbImage result_colours(const CombinedImage& image, int width, int height) {
    RgbImage colours(width, height);
    for (std::size_t p = 0; p < image.mean.size(); ++p) {
        const Rgb64& mean = image.mean[p];
        colours.pixels[p] = Rgb(static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z));
    }
    return colours;
}

std::vector<std::uint8_t> encode_picture(const CombinedImage& image, std::span<const AovChannel> aovs, int width,
                                         int height) {
    const auto alpha = std::find_if(aovs.begin(), aovs.end(), [](const AovChannel& aov) { return aov.name == "A"; });
    const std::span<const float> values = alpha == aovs.end() ? std::span<const float>() : alpha->values;
    return encode_png(straight_colours(result_colours(image, width, height), values), 1.0f, values);
}

StoredChannels result_channels(const CombinedImage& image, std::span<const AovChannel> aovs, int width, int height,
                               bool half) {
    StoredChannels stored{Image{width, height, {}, {}}, {}};
    Image& channels = stored.image;
    channels.data.reserve((12 + aovs.size()) * channels.pixel_count());
    const PixelType colours = half ? PixelType::half : PixelType::float32;
    const auto add = [&](const std::string& layer, const std::vector<Rgb64>& values, PixelType type) {
        add_layer(channels, layer, values);
        stored.types.insert(stored.types.end(), 3, type);
    };
    add("", image.mean, colours);
    add("variance", image.variance, PixelType::float32);
    add("halfA", image.half[0], colours);
    add("halfB", image.half[1], colours);
    for (const AovChannel& aov : aovs) {
        const std::span<float> channel = channels.add_channel(aov.name);
        std::copy(aov.values.begin(), aov.values.end(), channel.begin());
        stored.types.push_back(aov.precise ? PixelType::float32 : colours);
    }
    return stored;
}

}  // namespace treefarm
