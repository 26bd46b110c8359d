// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "common/image/image.h"

namespace treefarm {

/// How far an image is from a reference. All sums run in double, in pixel order. A figure that is undefined (nothing to
/// compare, a black reference under a ratio) is NaN.
struct ErrorMetrics {
    static constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

    std::uint64_t pixels = 0;
    std::uint64_t invalid_image = 0;       ///< pixels with a NaN or infinite channel in the image
    std::uint64_t invalid_reference = 0;   ///< pixels with a NaN or infinite channel in the reference
    std::uint64_t compared = 0;            ///< pixels that are finite in both: all figures are over these
    std::uint64_t negative_image = 0;      ///< compared pixels with a channel below 0 in the image
    std::uint64_t negative_reference = 0;  ///< compared pixels with a channel below 0 in the reference

    double mse = kUndefined;  ///< mean of (a - b)^2 over channels and pixels
    double rmse = kUndefined;
    double rel_mse = kUndefined;          ///< mean of (a - b)^2 / (b^2 + 0.01) over channels and pixels
    double rel_mse_trimmed = kUndefined;  ///< rel_mse without the worst `trimmed` pixels
    double mape = kUndefined;             ///< mean of |a - b| / (|b| + 0.01)
    double smape = kUndefined;            ///< mean of 2 |a - b| / (|a| + |b| + 0.01)
    std::uint64_t trimmed = 0;            ///< 0.1 % of the compared pixels, rounded down

    /// Compared pixels whose relative squared error, the mean over channels of (a - b)^2 / (b^2 + 0.01), is more than
    /// `outlier_limit`: 100 times its median over the pixels, and at least 1. So an outlier is off by more than its own
    /// value, and by ten times what is usual in the image. Unlike the trimmed share, their number is a finding.
    std::uint64_t outliers = 0;
    double outlier_limit = kUndefined;
    double worst = kUndefined;     ///< greatest relative squared error of a pixel
    int worst_x = 0, worst_y = 0;  ///< the first pixel that attains `worst`, from the left and from the top

    double mean_image = kUndefined;          ///< mean luminance
    double mean_reference = kUndefined;      ///< mean luminance
    double mean_ratio = kUndefined;          ///< mean_image / mean_reference
    double mean_ratio_trimmed = kUndefined;  ///< mean_ratio without the pixels that rel_mse_trimmed drops
    double channel_ratio[3] = {kUndefined, kUndefined, kUndefined};  ///< mean_ratio per channel
    double block_ratio_median = kUndefined;  ///< median over blocks of their luminance ratio: immune to outliers
};

/// Figures of `image` against `reference`; `block` is the side in pixels of the blocks of block_ratio_median, at
/// least 1. Throws InputError if the sizes differ.
ErrorMetrics measure_error(const RgbImage& image, const RgbImage& reference, int block = 16);

/// Throws InputError unless two images have the same size and at least one pixel.
void require_same_size(const RgbImage& image, const RgbImage& reference);

/// Whether all three channels are finite.
inline bool is_valid(const Rgb& c) {
    return is_finite(c);
}

}  // namespace treefarm
