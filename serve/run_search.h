// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "serve/confined_folder.h"

namespace treefarm {

/// Limits of a search, so that any folder costs little.
struct SearchLimits {
    std::size_t depth = 4;       ///< nesting of folders
    std::size_t folders = 5000;  ///< visited at most
    std::size_t runs = 500;      ///< returned at most
};

/// Run directories found by a search.
struct FoundRuns {
    std::vector<std::string> paths;  ///< relative to the root, the last written first; "": the root is one
    std::size_t left_out = 0;        ///< number of older ones omitted
};

/// Whether a folder is a run directory: it has a status.json.
bool is_run(const ConfinedFolder& root, const std::string& path);

/// Run directories below a root, without earlier runs that were set aside in others.
FoundRuns find_runs(const ConfinedFolder& root, const SearchLimits& limits = {});

}  // namespace treefarm
