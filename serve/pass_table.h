// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "serve/file_json.h"

namespace treefarm {

/// Rows of passes.csv as objects, the last 1000 at most: the columns shown by the page, as numbers, or null for an
/// empty field. An incomplete last line is omitted.
FileJson pass_table(const std::string& csv);

}  // namespace treefarm
