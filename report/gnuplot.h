#pragma once

#include <string>

namespace treefarm {

/// Runs gnuplot over a script and returns the SVG that it draws, without the XML header, ready to stand in a page. The
/// script sets no terminal or output. `name` distinguishes the ids of several pictures on one page. Throws RunError
/// where gnuplot is missing or complains.
std::string draw_svg(const std::string& script, const std::string& name, int width, int height);

/// Text in gnuplot's quotes, without its enhanced-text marks.
std::string gnuplot_quoted(const std::string& text);

}  // namespace treefarm
