// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "common/image/image.h"

namespace treefarm {

/// Errors of an image against a reference. Sums are in double, in pixel order. An undefined figure (no pixel to
/// compare, a ratio to a black reference) is NaN.
struct ErrorMetrics {
    static constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

    std::uint64_t pixels = 0;
    std::uint64_t invalid_image = 0;       ///< pixels with a NaN or infinite channel in the image
    std::uint64_t invalid_reference = 0;   ///< pixels with a NaN or infinite channel in the reference
    std::uint64_t compared = 0;            ///< pixels that are finite in both images; all figures are over these
    std::uint64_t negative_image = 0;      ///< compared pixels with a channel below 0 in the image
    std::uint64_t negative_reference = 0;  ///< compared pixels with a channel below 0 in the reference

    double mse = kUndefined;  ///< mean of (a - b)^2 over channels and pixels
    double rmse = kUndefined;
    double rel_mse = kUndefined;          ///< mean of (a - b)^2 / (b^2 + 0.01) over channels and pixels
    double rel_mse_trimmed = kUndefined;  ///< rel_mse without the worst `trimmed` pixels
    double mape = kUndefined;             ///< mean of |a - b| / (|b| + 0.01)
    double smape = kUndefined;            ///< mean of 2 |a - b| / (|a| + |b| + 0.01)
    std::uint64_t trimmed = 0;            ///< 0.1 % of the compared pixels, rounded down

    /// Compared pixels with a relative squared error (mean over channels of (a - b)^2 / (b^2 + 0.01)) above
    /// `outlier_limit`, which is 100 times the median over pixels, and at least 1. So an outlier is off by more than
    /// its own value and by ten times the usual error. Unlike the fixed share of trimmed pixels, their number says
    /// something about the image.
    std::uint64_t outliers = 0;
    double outlier_limit = kUndefined;
    double worst = kUndefined;     ///< greatest relative squared error of a pixel
    int worst_x = 0, worst_y = 0;  ///< first pixel with the error `worst`, in row order

    double mean_image = kUndefined;          ///< mean luminance
    double mean_reference = kUndefined;      ///< mean luminance
    double mean_ratio = kUndefined;          ///< mean_image / mean_reference
    double mean_ratio_trimmed = kUndefined;  ///< mean_ratio without the pixels that rel_mse_trimmed drops
    double channel_ratio[3] = {kUndefined, kUndefined, kUndefined};  ///< mean_ratio per channel
    double block_ratio_median =
        kUndefined;  ///< median over blocks of the ratio of their luminances; robust against outliers
};

/// Errors of `image` against `reference`. `block`: side in pixels, at least 1, of the blocks of block_ratio_median.
/// Throws InputError if the sizes differ.
ErrorMetrics measure_error(const RgbImage& image, const RgbImage& reference, int block = 16);

/// Throws InputError unless both images have the same size and at least one pixel.
void require_same_size(const RgbImage& image, const RgbImage& reference);

/// Whether all three channels are finite.
inline bool is_valid(const Rgb& c) {
    return is_finite(c);
}

}  // namespace treefarm
