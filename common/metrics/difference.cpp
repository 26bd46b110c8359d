// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/difference.h"

#include <algorithm>
#include <cmath>

#include "common/metrics/error_metrics.h"

namespace treefarm {

RgbImage difference_image(const RgbImage& image, const RgbImage& reference, double range) {
    require_same_size(image, reference);
    RgbImage result(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (!is_valid(image.pixels[i]) || !is_valid(reference.pixels[i])) {
            result.pixels[i] = Rgb(1.0f, 0.0f, 1.0f);
            continue;
        }
        const double a = luminance(Imath::Color3<double>(image.pixels[i]));
        const double b = luminance(Imath::Color3<double>(reference.pixels[i]));
        const auto t = static_cast<float>(std::clamp((a - b) / (std::abs(b) + 0.01) / range, -1.0, 1.0));
        const float rest = 1.0f - std::abs(t);
        result.pixels[i] = t > 0.0f ? Rgb(1.0f, rest, rest) : Rgb(rest, rest, 1.0f);
    }
    return result;
}

}  // namespace treefarm
