// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace treefarm {

/// A plot, to be drawn for the page or as files.
struct Picture {
    std::string name;         ///< of files and ids: letters, digits, _
    std::string title;        ///< for readers that cannot see
    std::string description;  ///< what it shows, for the same
    std::string script;       ///< gnuplot's, without terminal or output; empty: there is nothing to draw
    std::string data;         ///< what it shows as CSV
    int width = 460, height = 400;
};

/// How figures in files look.
struct FigureStyle {
    double width_inches = 3.3;
    std::string font = "Helvetica";
    double font_points = 8;
};

/// The picture as SVG, without the XML header, ready to stand in a page; "" where there is nothing to draw. Throws
/// RunError where gnuplot is missing or complains.
std::string draw_svg(const Picture& picture);

/// Writes NAME.svg, NAME.pdf and NAME.csv into a folder. False where this gnuplot cannot make PDF.
bool write_figure(const Picture& picture, const FigureStyle& style, const std::filesystem::path& folder);

/// Text in gnuplot's quotes, without its enhanced-text marks.
std::string gnuplot_quoted(const std::string& text);

}  // namespace treefarm
