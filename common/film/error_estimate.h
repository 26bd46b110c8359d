// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/film/combine.h"

namespace treefarm {

/// An image's estimate of its own error (docs/design/error.md, "error").
struct ErrorEstimate {
    bool known = false;         ///< false: no pass has two samples per pixel
    bool has_interval = false;  ///< false: no pass has four; low and high are then rmse
    double rmse = 0;  ///< root of the mean squared error over pixels and channels, as `treefarm compare` measures it
    double low = 0;   ///< 95 % interval of what this very image's error is: lower
    double high = 0;  ///< and upper end
    double mean = 0;  ///< mean luminance

    double mse() const { return rmse * rmse; }
    /// rmse / mean; 0 where there is no error, infinite for a black image that has one.
    double relative() const { return relative(rmse); }
    double relative_low() const { return relative(low); }
    double relative_high() const { return relative(high); }

  private:
    double relative(double error) const;
};

/// The error by the image's own variances. Its interval is a block bootstrap with random numbers of their own, keyed by
/// `seed`: the same for the same image.
ErrorEstimate estimate_error(const CombinedImage& image, std::uint64_t seed);

}  // namespace treefarm
