// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// A report that was written.
struct WrittenReport {
    std::filesystem::path page;
    std::vector<std::string> answers;  ///< who won and what 5 % costs, by the clock that is to be read first
    std::string warning;               ///< of times that were taken beside a busy processor; "" for none
};

/// Writes cells.csv, passes.csv and report.html of a study into its folder. Throws InputError where the folder is none
/// of a study, RunError where a file cannot be written or gnuplot is missing; the CSV files come first.
WrittenReport write_study_report(const std::filesystem::path& folder);

/// Writes the page of any results to a file.
WrittenReport write_page(const StudyResults& results, const std::filesystem::path& file);

}  // namespace treefarm
