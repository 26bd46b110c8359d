// SPDX-License-Identifier: Apache-2.0
#include "coordinator/result_image.h"

namespace treefarm {

namespace {

void add_layer(Image& image, const std::string& layer, const std::vector<Rgb64>& values) {
    const char* const components[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const std::span<float> channel = image.add_channel(channel_name(layer, components[c]));
        for (std::size_t p = 0; p < values.size(); ++p)
            channel[p] = static_cast<float>(values[p][c]);
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

Image result_channels(const CombinedImage& image, int width, int height) {
    Image channels{width, height, {}, {}};
    channels.data.reserve(12 * channels.pixel_count());
    add_layer(channels, "", image.mean);
    add_layer(channels, "variance", image.variance);
    add_layer(channels, "halfA", image.half[0]);
    add_layer(channels, "halfB", image.half[1]);
    return channels;
}

}  // namespace treefarm
