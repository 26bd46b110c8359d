#pragma once

#include <filesystem>
#include <string>

#include "report/study_results.h"

namespace treefarm {

/// The report as one HTML page that needs nothing beside it. Throws RunError where gnuplot cannot draw.
std::string study_page(const StudyResults& results);

/// Writes cells.csv, passes.csv and report.html into a study's folder and returns the page's path. Throws InputError
/// where the folder is none of a study, RunError where a file cannot be written or gnuplot is missing; the CSV files
/// come first.
std::filesystem::path write_study_report(const std::filesystem::path& folder);

}  // namespace treefarm
