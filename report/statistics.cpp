// SPDX-License-Identifier: Apache-2.0
#include "report/statistics.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace treefarm {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// 97.5 % quantile of Student's t with `freedom` degrees of freedom.
double t_quantile(std::size_t freedom) {
    // In double: valgrind has no long double, and Boost's constants in it overflow there before main().
    using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
    return boost::math::quantile(boost::math::students_t_distribution<double, InDouble>(static_cast<double>(freedom)),
                                 0.975);
}

double log_interpolate(const CurvePoint& a, const CurvePoint& b, double fraction) {
    return std::exp(std::log(a.error) + fraction * (std::log(b.error) - std::log(a.error)));
}

}  // namespace

Interval geometric_mean(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    if (values.empty()) return {kNan, kNan, kNan, 0};
    double sum = 0, squares = 0;
    for (const double value : values)
        sum += std::log(value);
    const double mean = sum / n;
    for (const double value : values)
        squares += (std::log(value) - mean) * (std::log(value) - mean);
    if (values.size() < 2) return {std::exp(mean), kNan, kNan, 1};
    const double half = t_quantile(values.size() - 1) * std::sqrt(squares / (n - 1) / n);
    return {std::exp(mean), std::exp(mean - half), std::exp(mean + half), values.size()};
}

Interval geometric_ratio(std::span<const double> a, std::span<const double> b) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
        ratios.push_back(a[k] / b[k]);
    return geometric_mean(ratios);
}

Crossing time_to(std::span<const CurvePoint> curve, double target) {
    if (curve.empty()) return {kNan, true};
    if (curve.front().error <= target) return {curve.front().seconds, false};
    for (std::size_t k = 1; k < curve.size(); ++k) {
        const CurvePoint &a = curve[k - 1], &b = curve[k];
        if (b.error > target) continue;
        const double fraction = (std::log(a.error) - std::log(target)) / (std::log(a.error) - std::log(b.error));
        return {std::exp(std::log(a.seconds) + fraction * (std::log(b.seconds) - std::log(a.seconds))), false};
    }
    const double ratio = curve.back().error / target;
    return {curve.back().seconds * ratio * ratio, true};
}

double error_at(std::span<const CurvePoint> curve, double seconds) {
    if (curve.empty()) return kNan;
    for (std::size_t k = 1; k < curve.size(); ++k) {
        const CurvePoint &a = curve[k - 1], &b = curve[k];
        if (seconds > b.seconds && k + 1 < curve.size()) continue;
        const double length = std::log(b.seconds) - std::log(a.seconds);
        const double fraction = length > 0 ? (std::log(seconds) - std::log(a.seconds)) / length : 1.0;
        return log_interpolate(a, b, std::clamp(fraction, 0.0, 1.0));
    }
    return curve.front().error;
}

}  // namespace treefarm
