// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/statistics.h"

namespace treefarm {

// Figures as they stand in pages and messages: three digits.

/// Fewer seeds say nothing of chance: Student's t of two is 12.7 standard errors.
inline constexpr std::size_t kLeastSeeds = 3;

/// True where a ratio can be told from 1: enough values, and a 95 % interval without 1.
bool differs_from_one(const Interval& ratio);

/// "1.23 [1.1, 1.4]"; without the interval where too few values make it.
std::string interval_text(const Interval& interval);

/// How many times: "2.1 [1.8, 2.4]"; says "cannot tell" where the ratio cannot be told from 1.
std::string gain_text(const Interval& ratio);

/// "3.2 s", "4.1 min", with the letter of its unit; core-seconds: "3.2 core-s".
std::string time_text(double seconds, bool of_cores);
/// A time with its interval, unless that is wider than one to ten.
std::string time_text(const Interval& seconds, bool of_cores);

/// "12.3 %"
std::string percent_text(double fraction);

/// "3 seeds"
std::string seeds_text(std::size_t seeds);

}  // namespace treefarm
