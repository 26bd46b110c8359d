// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serve/run_view.h"

namespace treefarm {

/// Entries of runs in a list (run_entry()), each kept until a file of its run changes: most runs of a folder have
/// ended.
class RunEntries {
  public:
    /// Entries of these runs, and of no others are any kept.
    nlohmann::ordered_json of(const ConfinedFolder& root, const std::vector<std::string>& paths, const Here& here);

  private:
    struct Kept {
        std::string version;   ///< of the run's files
        std::int64_t now = 0;  ///< Unix seconds
        nlohmann::ordered_json entry;
    };
    std::map<std::string, Kept> kept_;
};

}  // namespace treefarm
