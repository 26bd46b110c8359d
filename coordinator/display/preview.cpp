// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/preview.h"

namespace treefarm {

namespace {

Rgb to_float(const Rgb64& colour) {
    return Rgb(static_cast<float>(colour.x), static_cast<float>(colour.y), static_cast<float>(colour.z));
}

}  // namespace

PassPixels pass_pixels(std::span<const PixelEstimate> film) {
    PassPixels pass;
    pass.pixels.resize(film.size());
    for (std::size_t p = 0; p < film.size(); ++p) {
        const Moments &a = film[p].half[0], &b = film[p].half[1];
        const double samples = static_cast<double>(a.n) + static_cast<double>(b.n);
        if (samples == 0) continue;
        const Rgb64 sum = a.mean * static_cast<double>(a.n) + b.mean * static_cast<double>(b.n);
        pass.pixels[p] = {to_float(sum / samples), static_cast<float>(samples)};
    }
    return pass;
}

RgbImage preview_image(const CombinedImage& image, std::uint32_t spp, const PassPixels& pass, int width, int height) {
    RgbImage preview(width, height);
    for (std::size_t p = 0; p < preview.pixels.size(); ++p) {
        const Rgb finished = image.mean.empty() ? Rgb(0.0f) : to_float(image.mean[p]);
        const float before = image.mean.empty() ? 0.0f : static_cast<float>(spp);
        const PassPixels::Pixel now = pass.pixels.empty() ? PassPixels::Pixel() : pass.pixels[p];
        const float samples = before + now.samples;
        if (samples > 0) preview.pixels[p] = (finished * before + now.mean * now.samples) / samples;
    }
    return preview;
}

}  // namespace treefarm
