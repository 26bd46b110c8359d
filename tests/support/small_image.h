// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "common/image/image.h"

namespace treefarm::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

/// An image of these pixels, row by row.
inline RgbImage image_of(int width, int height, const std::vector<Rgb>& pixels) {
    RgbImage image(width, height);
    image.pixels = pixels;
    return image;
}

}  // namespace treefarm::test
