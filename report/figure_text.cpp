// SPDX-License-Identifier: Apache-2.0
#include "report/figure_text.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "common/base/text/duration_text.h"

namespace treefarm {

namespace {

/// Ratio of its bounds above which an interval is not shown.
constexpr double kWidest = 10;

/// A bound with three digits, or more where it would read as the 1 that it is not.
std::string bound_text(double bound) {
    const std::string text = fmt::format("{:.3g}", bound);
    return text == "1" && bound != 1 ? fmt::format("{:.4g}", bound) : text;
}

bool has_interval(const Interval& interval) {
    return interval.values >= kLeastSeeds && std::isfinite(interval.low);
}

}  // namespace

bool differs_from_one(const Interval& ratio) {
    return has_interval(ratio) && (ratio.low > 1 || ratio.high < 1);
}

std::string interval_text(const Interval& interval) {
    if (!std::isfinite(interval.mean)) return "?";
    std::string text = fmt::format("{:.3g}", interval.mean);
    if (has_interval(interval)) text += fmt::format(" [{}, {}]", bound_text(interval.low), bound_text(interval.high));
    return text;
}

std::string gain_text(const Interval& ratio) {
    if (!std::isfinite(ratio.mean)) return "?";
    if (ratio.values < kLeastSeeds) return interval_text(ratio) + " (" + seeds_text(ratio.values) + ": cannot tell)";
    if (differs_from_one(ratio)) return interval_text(ratio);
    const bool is_wide = ratio.high > kWidest * ratio.low;
    return (is_wide ? fmt::format("{:.3g}", ratio.mean) : interval_text(ratio)) + " (cannot tell)";
}

std::string time_text(double seconds, bool of_cores) {
    if (!std::isfinite(seconds)) return "?";
    const std::string text = seconds < 59.95 ? fmt::format("{:.3g} s", seconds) : duration_text(seconds);
    return of_cores ? text + " of a core" : text;
}

std::string time_text(const Interval& seconds, bool of_cores) {
    std::string text = time_text(seconds.mean, of_cores);
    if (!has_interval(seconds) || seconds.high > kWidest * seconds.low) return text;
    return text + " [" + time_text(seconds.low, of_cores) + ", " + time_text(seconds.high, of_cores) + "]";
}

std::string percent_text(double fraction) {
    return fmt::format("{:.3g} %", 100 * fraction);
}

std::string seeds_text(std::size_t seeds) {
    return fmt::format("{} seed{}", seeds, seeds == 1 ? "" : "s");
}

}  // namespace treefarm
