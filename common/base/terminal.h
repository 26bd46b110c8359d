// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Abilities of an output stream, found out by cli/launch_environment.cpp.
struct TerminalKind {
    bool live = false;    ///< a terminal that can redraw a line, by escape sequences
    bool colour = false;  ///< a live terminal that shows colours
};

/// Width in columns of the terminal behind this descriptor; 80 if unknown.
int terminal_columns(int descriptor);

/// Columns that a UTF-8 text takes: combining marks take none, East Asian wide characters two.
int text_columns(const std::string& text);

/// Longest beginning of the text that fits into `columns` columns.
std::string cut_to_columns(const std::string& text, int columns);

}  // namespace treefarm
