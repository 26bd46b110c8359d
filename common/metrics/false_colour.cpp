// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/false_colour.h"

#include <algorithm>
#include <cmath>

#include "common/image/srgb.h"

namespace treefarm {

Rgb cubehelix(float t) {
    const float angle = 2.0f * kPi * (0.5f / 3.0f - 1.5f * t), amplitude = 0.5f * t * (1.0f - t);
    const float c = amplitude * std::cos(angle), s = amplitude * std::sin(angle);
    const auto linear = [](float shown) { return srgb_decode(std::clamp(shown, 0.0f, 1.0f)); };
    return {linear(t - 0.14861f * c + 1.78277f * s), linear(t - 0.29227f * c - 0.90649f * s), linear(t + 1.97294f * c)};
}

RgbImage false_colour(const Plane& map) {
    RgbImage image(map.width, map.height, Rgb(1.0f, 0.0f, 1.0f));
    for (std::size_t i = 0; i < map.values.size(); ++i)
        if (!std::isnan(map.values[i])) image.pixels[i] = cubehelix(std::clamp(map.values[i], 0.0f, 1.0f));
    return image;
}

}  // namespace treefarm
