// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/film/pixel_estimate.h"

namespace treefarm {

/// The light about each pixel of an image, by which its noise is judged: the mean luminance of its block of 8 x 8
/// pixels, at least a tenth of the image's. Without that floor a corner lit through a keyhole would be all that counts.
struct ImageLevels {
    std::size_t columns = 0;            ///< of blocks
    std::vector<float> inverse_levels;  ///< one over the light of each block, row by row; empty: the image is black

    /// Whether they are of an image of so many pixels in rows of `width`.
    bool fits(std::size_t pixels, std::size_t width) const;
    /// One over the light about a pixel of an image that they fit.
    float at(std::size_t pixel, std::size_t width) const;
};
ImageLevels image_levels(std::span<const Rgb64> image, std::size_t width);

/// Variance of one sample, relative to the square of the light about its pixel: the mean over the pixels. 0: not
/// known.
double mean_variance(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width);
/// As mean_variance(), without the worst 0.1 % of the pixels: what a single firefly does not change.
double relative_variance(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width);

}  // namespace treefarm
