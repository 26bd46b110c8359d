// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace treefarm {

/// The text in one line and harmless to terminals: control characters (line ends, escapes, those of C1 too) and bytes
/// that are not UTF-8 are replaced by "?". What comes from files and other hosts may hold anything.
std::string printable(std::string_view text);

}  // namespace treefarm
