// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "serve/file_json.h"

namespace treefarm {

/// Rows of passes.csv as objects, the last 1000 at most: columns that the page shows, as numbers, or null where a field
/// is empty. A last line that is only half written is left out.
FileJson pass_table(const std::string& csv);

}  // namespace treefarm
