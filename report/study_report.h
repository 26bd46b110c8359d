// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Result of writing a report.
struct WrittenReport {
    std::filesystem::path page;
    std::vector<std::string> answers;  ///< winner and price of 5 % error, by the clock to be read first
    std::string warning;               ///< about times measured on a busy processor; "" for none
};

/// Writes cells.csv, passes.csv and report.html of a study into its folder. Throws InputError if the folder is no
/// study's, RunError if a file cannot be written or gnuplot is missing; the CSV files are written first.
WrittenReport write_study_report(const std::filesystem::path& folder);

/// Writes the page of any results to a file.
WrittenReport write_page(const StudyResults& results, const std::filesystem::path& file);

}  // namespace treefarm
