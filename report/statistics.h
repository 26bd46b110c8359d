// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace treefarm {

/// A mean with its 95 % interval; low and high are NaN for a single value.
struct Interval {
    double mean = 0, low = 0, high = 0;
    std::size_t values = 0;  ///< number of values
};

/// Geometric mean of positive values, with the interval of Student's t on their logarithms. NaN without values.
Interval geometric_mean(std::span<const double> values);

/// Geometric mean of the ratios a[k] / b[k] of paired values, with its interval as in geometric_mean().
Interval geometric_ratio(std::span<const double> a, std::span<const double> b);

/// A point of an error curve: seconds, and the error then.
struct CurvePoint {
    double seconds = 0, error = 0;
};

/// Time at which a curve reaches an error.
struct Crossing {
    double seconds = 0;
    bool extrapolated = false;  ///< it does so beyond the measured range
};

/// First time at which the error is at most `target`: linear in log-log between points; beyond the last point it falls
/// with the inverse square root of time. Not before the first point: an image exists from its first pass on.
Crossing time_to(std::span<const CurvePoint> curve, double target);

/// Error at a time between the first and the last point, linear in log-log.
double error_at(std::span<const CurvePoint> curve, double seconds);

}  // namespace treefarm
