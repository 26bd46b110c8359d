// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/runs/run_json.h"
#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// JSON of an error estimate in a run's files; null if the error is unknown. Infinite values are null.
RunJson error_record(const ErrorEstimate& error);
RunJson forecast_record(const ErrorForecast& forecast);

/// JSON of a pass's figures for `place`, kInSummary or kInCell.
RunJson pass_record(const PassReport& report, unsigned place);

/// Header line and a pass's line of passes.csv, without line ends.
std::string pass_csv_header();
std::string pass_csv_line(const PassReport& report);

}  // namespace treefarm
