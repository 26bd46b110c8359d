// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// One short line for anybody: "pass 6/7   63 spp   7.1 s   error 42.8 %   half of it in about 1:10". Where an error
/// was asked for, the time is until that. What is not known is left out. `pass_count`: 0 where it is not known.
std::string pass_line(const PassReport& report, std::size_t pass_count);

/// Every figure of a pass, for who knows them.
std::string pass_summary(const PassReport& report, std::size_t pass_count);

/// "pass 6/7", or "pass 6".
std::string pass_name(std::uint32_t index, std::size_t pass_count);

/// "0.25 s", "7.1 s", "1:10" (minutes), "2:30:00" (hours), "12.5 h", "12 days".
std::string duration_text(double seconds);

/// A duration to come, as duration_text() but in whole seconds, at least one: it is not known better.
std::string rough_duration_text(double seconds);

/// "about ", "at most ", "roughly ", or empty where nothing is known.
const char* trust_words(Trust trust);

/// "about 12 s", "at most 12 s (still learning)".
std::string forecast_text(const ErrorForecast& forecast);

/// "error 4.2 %", or that it is not known, or that there is none to be seen.
std::string brief_error_text(const ErrorEstimate& error);

/// The error with its interval: "error 4.2 % [4.0, 4.4]".
std::string error_text(const ErrorEstimate& error);

}  // namespace treefarm
