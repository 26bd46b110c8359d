// SPDX-License-Identifier: Apache-2.0
#include "common/base/text/duration_text.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace treefarm {

namespace {

constexpr long kMinute = 60, kHour = 3600, kDay = 86400;

/// Whole seconds as "59 s", "1:10", "2:30:00" or "12 days".
std::string clock_text(long seconds) {
    if (seconds < kMinute) return fmt::format("{} s", seconds);
    if (seconds < kHour) return fmt::format("{}:{:02}", seconds / kMinute, seconds % kMinute);
    if (seconds < 2 * kDay)
        return fmt::format("{}:{:02}:{:02}", seconds / kHour, seconds / kMinute % 60, seconds % kMinute);
    return fmt::format("{} days", (seconds + kDay / 2) / kDay);
}

}  // namespace

std::string duration_text(double seconds) {
    if (seconds < 0.95) return fmt::format("{:.2g} s", seconds);
    if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
    return seconds < 1e9 ? clock_text(std::lround(seconds)) : "a very long time";
}

std::string limit_text(double seconds) {
    if (seconds < kMinute) return fmt::format("{:.3g} s", seconds);
    return duration_text(seconds);
}

std::string rough_duration_text(double seconds) {
    if (!(seconds < 1e9)) return "a very long time";
    const long whole = std::max(1L, std::lround(seconds));
    return clock_text(whole < kHour ? whole : (whole + kMinute / 2) / kMinute * kMinute);
}

}  // namespace treefarm
