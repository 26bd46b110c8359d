// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Duration in words: "0.25 s", "7.1 s", "1:10" (minutes), "2:30:00" (hours), "12 days".
std::string duration_text(double seconds);

/// Forecast duration, as duration_text() but in whole seconds, at least one, and above an hour in whole minutes:
/// forecasts are no more accurate.
std::string rough_duration_text(double seconds);

/// Duration that somebody has set, in no more digits than that takes: "10 s", "0.5 s", "1:30".
std::string limit_text(double seconds);

}  // namespace treefarm
