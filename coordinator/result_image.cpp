#include "coordinator/result_image.h"

namespace treefarm {

namespace {

RgbImage to_rgb(const std::vector<Rgb64>& values, int width, int height) {
    RgbImage image(width, height);
    for (std::size_t p = 0; p < values.size(); ++p)
        image.pixels[p] =
            Rgb(static_cast<float>(values[p].x), static_cast<float>(values[p].y), static_cast<float>(values[p].z));
    return image;
}

}  // namespace

RgbImage result_colours(const CombinedImage& image, int width, int height) {
    return to_rgb(image.mean, width, height);
}

Image result_channels(const CombinedImage& image, int width, int height) {
    Image channels;
    add_rgb_layer(channels, "", to_rgb(image.mean, width, height));
    add_rgb_layer(channels, "variance", to_rgb(image.variance, width, height));
    add_rgb_layer(channels, "halfA", to_rgb(image.half[0], width, height));
    add_rgb_layer(channels, "halfB", to_rgb(image.half[1], width, height));
    return channels;
}

}  // namespace treefarm
