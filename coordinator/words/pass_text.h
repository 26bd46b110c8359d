// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// Short line on a pass for any user: "pass 6/7   63 spp   7.1 s   error 42.8 %   half in about 1:10". With a
/// target error the time is until that. Unknown figures are omitted. `pass_count`: 0 if unknown.
std::string pass_line(const PassReport& report, std::size_t pass_count);

/// Line with every figure of a pass, for expert users.
std::string pass_summary(const PassReport& report, std::size_t pass_count);

/// Name of a pass: "pass 6/7", or "pass 6".
std::string pass_name(std::uint32_t index, std::size_t pass_count);

/// Trust of a forecast: "about ", "at most ", "roughly ", or empty if unknown.
const char* trust_words(Trust trust);

/// Forecast in words: "about 12 s", "at most 12 s (still learning)".
std::string forecast_text(const ErrorForecast& forecast);

/// Error in words: "error 4.2 %", or that it is unknown or not visible.
std::string brief_error_text(const ErrorEstimate& error);

/// Error with its interval: "error 4.2 % [4.0, 4.4]".
std::string error_text(const ErrorEstimate& error);

}  // namespace treefarm
