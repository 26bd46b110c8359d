// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/runs/run_json.h"
#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// An estimate as the files of a run have it; null where the error is not known. What is infinite is written as null.
RunJson error_record(const ErrorEstimate& error);
RunJson forecast_record(const ErrorForecast& forecast);

/// The figures of a pass for `place`, kInSummary or kInCell.
RunJson pass_record(const PassReport& report, unsigned place);

/// Header line and a pass's line of passes.csv, without line ends.
std::string pass_csv_header();
std::string pass_csv_line(const PassReport& report);

}  // namespace treefarm
