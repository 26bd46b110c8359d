// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Abilities of whatever shows a stream. cli/launch_environment.cpp finds them out; the rest of the program is told.
struct TerminalKind {
    bool live = false;    ///< a terminal on which a line can be drawn again, by escape sequences
    bool colour = false;  ///< words of a live terminal can have a colour
};

/// Columns of the terminal behind this descriptor, as of now; 80 where nobody knows.
int terminal_columns(int descriptor);

/// Columns that a UTF-8 text takes: none for marks that combine, two for East Asian characters and the like.
int text_columns(const std::string& text);

/// The text's beginning, as far as it fits into so many columns.
std::string cut_to_columns(const std::string& text, int columns);

}  // namespace treefarm
