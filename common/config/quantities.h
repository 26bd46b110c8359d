// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace treefarm {

/// Seconds, from a number or a number with a unit: "90", "90s", "1.5 min", "2m", "1h". Nothing for other text.
std::optional<double> parse_duration(std::string_view text);

/// A share of one, from a number or a percentage: "0.05", "5%", "5 %". Nothing for other text.
std::optional<double> parse_fraction(std::string_view text);

/// budget.error. A black image is off by the root mean square of the true one, which is at least its mean: above 1 an
/// image need not show anything.
inline constexpr double kGreatestError = 1.0;
inline constexpr double kLeastError = 1e-6;

/// budget.seconds: from what a pass takes at least to three years.
inline constexpr double kLeastSeconds = 1e-3;
inline constexpr double kMostSeconds = 1e8;

}  // namespace treefarm
