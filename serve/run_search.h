// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "serve/confined_folder.h"

namespace treefarm {

/// Limits of a search, so that a folder of anything costs little.
struct SearchLimits {
    std::size_t depth = 4;       ///< folders in folders
    std::size_t folders = 5000;  ///< looked into, at most
    std::size_t runs = 500;      ///< returned, at most
};

/// Run directories that were found.
struct FoundRuns {
    std::vector<std::string> paths;  ///< from the root on, the last written first; "": the root is one
    std::size_t left_out = 0;        ///< older ones
};

/// Whether a folder is a run directory: it has a status.json.
bool is_run(const ConfinedFolder& root, const std::string& path);

/// The run directories below a root, those that lie aside in others left out.
FoundRuns find_runs(const ConfinedFolder& root, const SearchLimits& limits = {});

}  // namespace treefarm
