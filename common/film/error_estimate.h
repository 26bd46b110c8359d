// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/film/combine.h"

namespace treefarm {

/// Estimate of an image's own error (docs/design/error.md, "error").
struct ErrorEstimate {
    bool known = false;         ///< false: no pass has two samples per pixel
    bool has_interval = false;  ///< false: no pass has four samples per pixel; low and high equal rmse
    double rmse = 0;            ///< root of the mean squared error over pixels and channels, as in `treefarm compare`
    double low = 0;             ///< lower end of a 95 % interval for the error of this image
    double high = 0;            ///< upper end
    double mean = 0;            ///< mean luminance

    double mse() const { return rmse * rmse; }
    /// Ratio rmse / mean; 0 without error, infinite for a black image with an error.
    double relative() const { return relative(rmse); }
    double relative_low() const { return relative(low); }
    double relative_high() const { return relative(high); }

  private:
    double relative(double error) const;
};

/// Error from the image's own variances. The interval is a block bootstrap with its own random numbers, keyed by
/// `seed`: equal images give equal intervals.
ErrorEstimate estimate_error(const CombinedImage& image, std::uint64_t seed);

}  // namespace treefarm
