// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Light level around each pixel, the unit in which its noise is measured: the mean luminance of its block of 8 x 8
/// pixels, at least a tenth of the image's mean. Without that floor, a corner lit through a keyhole would dominate.
struct ImageLevels {
    std::size_t columns = 0;            ///< blocks per row
    std::vector<float> inverse_levels;  ///< reciprocal level of each block, row by row; empty: the image is black

    /// Whether the levels fit an image of so many pixels in rows of `width`.
    bool fits(std::size_t pixels, std::size_t width) const;
    /// Reciprocal level at a pixel of an image that the levels fit.
    float at(std::size_t pixel, std::size_t width) const;
};
ImageLevels image_levels(std::span<const Rgb64> image, std::size_t width);

/// Variance of one sample relative to the squared level: mean over pixels. 0: unknown.
double mean_variance(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width);
/// Like mean_variance(), without the worst 0.1 % of the pixels, so that single fireflies do not matter.
double relative_variance(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width);

}  // namespace treefarm
