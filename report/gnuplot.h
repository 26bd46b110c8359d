// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace treefarm {

/// A plot, for the page or as files.
struct Picture {
    std::string name;         ///< base of files and ids: letters, digits, _
    std::string title;        ///< for blind readers
    std::string description;  ///< content in words, for blind readers
    std::string script;       ///< commands for gnuplot, without terminal or output; empty: nothing to draw
    std::string data;         ///< plotted data as CSV
    int width = 460, height = 400;
};

/// Style of figures in files.
struct FigureStyle {
    double width_inches = 3.3;
    std::string font = "Helvetica";
    double font_points = 8;
};

/// SVG of a picture without the XML header, for embedding in a page; "" if there is nothing to draw. Throws RunError if
/// gnuplot is missing or fails.
std::string draw_svg(const Picture& picture);

/// Writes NAME.svg, NAME.pdf and NAME.csv into a folder. False if gnuplot cannot write PDF.
bool write_figure(const Picture& picture, const FigureStyle& style, const std::filesystem::path& folder);

/// Text as a gnuplot string, without enhanced-text marks.
std::string gnuplot_quoted(const std::string& text);

}  // namespace treefarm
