// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace treefarm {

/// A mean with its 95 % interval; low and high are NaN where one value says nothing of its spread.
struct Interval {
    double mean = 0, low = 0, high = 0;
    std::size_t values = 0;  ///< that it is made of
};

/// Geometric mean of positive values, with the interval of Student's t on their logarithms. NaN for no values.
Interval geometric_mean(std::span<const double> values);

/// Geometric mean of the ratios a[k] / b[k] of paired values, with its interval as of geometric_mean().
Interval geometric_ratio(std::span<const double> a, std::span<const double> b);

/// An error that falls with time: seconds, and the error then.
struct CurvePoint {
    double seconds = 0, error = 0;
};

/// The time when a curve comes down to an error.
struct Crossing {
    double seconds = 0;
    bool extrapolated = false;  ///< it does not within what was measured
};

/// The first time at which the error is down to `target`: straight in log-log between points, beyond the last point
/// as the inverse square root of time. At the earliest the first point's time: an image is there when its pass is.
Crossing time_to(std::span<const CurvePoint> curve, double target);

/// The error at a time between the first and the last point, straight in log-log.
double error_at(std::span<const CurvePoint> curve, double seconds);

}  // namespace treefarm
