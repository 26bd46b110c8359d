// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace treefarm {

/// Seconds from a number or a number with a unit: "90", "90s", "1.5 min", "2m", "1h". Empty for other text.
std::optional<double> parse_duration(std::string_view text);

/// Fraction from a number or a percentage: "0.05", "5%", "5 %". Empty for other text.
std::optional<double> parse_fraction(std::string_view text);

/// Limit of budget.error. A black image has an error of the root mean square of the true image, which is at least its
/// mean: above 1 an image need not show anything.
inline constexpr double kGreatestError = 1.0;
inline constexpr double kLeastError = 1e-6;

/// Limits of budget.seconds: about the shortest pass, and three years.
inline constexpr double kLeastSeconds = 1e-3;
inline constexpr double kMostSeconds = 1e8;

}  // namespace treefarm
