// SPDX-License-Identifier: Apache-2.0
#include "common/image/image.h"

#include <algorithm>

#include "common/base/error.h"

namespace treefarm {

namespace {

constexpr const char* kComponents[3] = {"R", "G", "B"};

}  // namespace

std::optional<std::size_t> Image::find(const std::string& name) const {
    const auto at = std::find(channel_names.begin(), channel_names.end(), name);
    if (at == channel_names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - channel_names.begin());
}

std::span<float> Image::add_channel(const std::string& name) {
    channel_names.push_back(name);
    data.resize(channel_names.size() * pixel_count(), 0.0f);
    return channel(channel_names.size() - 1);
}

std::string channel_name(const std::string& layer, const std::string& component) {
    return layer.empty() ? component : layer + "." + component;
}

std::optional<RgbImage> rgb_layer(const Image& image, const std::string& layer) {
    std::optional<std::size_t> index[3];
    for (int c = 0; c < 3; ++c)
        index[c] = image.find(channel_name(layer, kComponents[c]));
    if (!index[0] || !index[1] || !index[2]) {
        const auto grey = image.find(channel_name(layer, "Y"));
        if (!grey) return std::nullopt;
        std::fill(std::begin(index), std::end(index), grey);
    }
    RgbImage rgb(image.width, image.height);
    for (int c = 0; c < 3; ++c) {
        const auto values = image.channel(*index[c]);
        for (std::size_t i = 0; i < values.size(); ++i)
            rgb.pixels[i][c] = values[i];
    }
    return rgb;
}

void add_rgb_layer(Image& image, const std::string& layer, const RgbImage& rgb) {
    if (image.channel_names.empty()) {
        image.width = rgb.width;
        image.height = rgb.height;
    }
    if (image.width != rgb.width || image.height != rgb.height)
        throw RunError("the layer '" + layer + "' has " + std::to_string(rgb.width) + " x " +
                       std::to_string(rgb.height) + " pixels, the image " + std::to_string(image.width) + " x " +
                       std::to_string(image.height));
    for (int c = 0; c < 3; ++c) {
        const auto values = image.add_channel(channel_name(layer, kComponents[c]));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = rgb.pixels[i][c];
    }
}

RgbImage straight_colours(RgbImage image, std::span<const float> alpha) {
    for (std::size_t i = 0; i < alpha.size(); ++i)
        if (alpha[i] > 0.0f) image.pixels[i] /= alpha[i];
    return image;
}

std::span<const float> alpha_of(const Image& image) {
    const auto alpha = image.find("A");
    return alpha ? image.channel(*alpha) : std::span<const float>();
}

RgbImage cut_out(const RgbImage& image, const CropWindow& crop, int width, int height) {
    if (crop.x < 0 || crop.y < 0 || crop.x > image.width - width || crop.y > image.height - height)
        throw RunError("a window that is not on its image");
    RgbImage part(width, height);
    for (int y = 0; y < height; ++y) {
        const auto row = image.pixels.begin() + std::ptrdiff_t{crop.y + y} * image.width + crop.x;
        std::copy(row, row + width, part.pixels.begin() + std::ptrdiff_t{y} * width);
    }
    return part;
}

}  // namespace treefarm
