// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "report/gnuplot.h"
#include "report/study_results.h"

namespace treefarm {

/// Inches of a width as "3.3in", "84mm", "8.4 cm". Throws InputError for other texts, and outside of 1 to 40 inches.
double figure_width(const std::string& text);

/// Number and formats of the exported figures.
struct ExportedFigures {
    int figures = 0;
    bool with_pdf = true;  ///< false: gnuplot cannot write PDF
};

/// Writes every chart of the page as SVG, PDF and CSV into a folder, which is created. Throws RunError if gnuplot or a
/// file fails.
ExportedFigures export_figures(const StudyResults& results, const FigureStyle& style,
                               const std::filesystem::path& folder);

}  // namespace treefarm
