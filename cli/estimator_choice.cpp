// SPDX-License-Identifier: Apache-2.0
#include "cli/estimator_choice.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace treefarm {

namespace {

/// Logarithm of squared error times seconds, with the half width of its interval.
struct Cost {
    double logarithm = 0, half = 0;
};

Cost cost(const Expectation& of) {
    const auto log_of = [](double error, double seconds) { return 2 * std::log(error) + std::log(seconds); };
    const double low = log_of(of.error.low, of.seconds.low), high = log_of(of.error.high, of.seconds.high);
    return {log_of(of.error.value, of.seconds.value), 0.5 * (high - low)};
}

}  // namespace

Expected times_as_fast(const Expectation& other, const Expectation& own) {
    if (!other.known || !own.known) return {};
    const Cost a = cost(own), b = cost(other);
    const double ratio = std::exp(a.logarithm - b.logarithm), spread = std::exp(std::hypot(a.half, b.half));
    if (!std::isfinite(ratio) || !std::isfinite(spread)) return {};
    return {ratio, ratio / spread, ratio * spread};
}

std::string estimator_choice_text(const EstimatorAdvice& other, const std::string& own, const Expected& by) {
    if (!(by.value > 0)) return "";
    const std::string figure =
        fmt::format("{:.2g} [{:.2g}, {:.2g}] times as fast as {} to equal error", by.value, by.low, by.high, own);
    if (by.low > 1)
        return fmt::format("faster here: --set integrator.type={}, {} by a probe of both; {}", other.type, figure,
                           other.reason);
    return fmt::format("{} stays: {} was probed, too, and came to {}", own, other.type, figure);
}

std::string untried_estimator_text(const EstimatorAdvice& other, const std::string& own) {
    return fmt::format("{} and {} can be compared by a probe ({}): add --error 5%", own, other.type, other.reason);
}

}  // namespace treefarm
