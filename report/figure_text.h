// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/statistics.h"

namespace treefarm {

// Figures as texts in pages and messages: three significant digits.

/// Least number of seeds for an interval: Student's t of two is 12.7 standard errors.
inline constexpr std::size_t kLeastSeeds = 3;

/// Whether a ratio differs significantly from 1: enough values, and a 95 % interval without 1.
bool differs_from_one(const Interval& ratio);

/// "1.23 [1.1, 1.4]"; without the interval if there are too few values.
std::string interval_text(const Interval& interval);

/// Ratio in words: "2.1 [1.8, 2.4]", with "cannot tell" if it does not differ significantly from 1.
std::string gain_text(const Interval& ratio);

/// Time: "3.2 s", "1:40" (minutes), "2:30:00" (hours); core-seconds: "1:40 of a core".
std::string time_text(double seconds, bool of_cores);
/// Time with its interval, unless that spans more than a factor of ten.
std::string time_text(const Interval& seconds, bool of_cores);

/// Percentage: "12.3 %"
std::string percent_text(double fraction);

/// Number of seeds: "3 seeds"
std::string seeds_text(std::size_t seeds);

}  // namespace treefarm
