// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace treefarm {

/// The text on one line, safe for terminals: control characters (line ends, escapes, also C1) and bytes that are not
/// UTF-8 become "?". For text from files and other hosts.
std::string printable(std::string_view text);

/// printable() for each line of a text.
std::string printable_lines(std::string_view text);

}  // namespace treefarm
