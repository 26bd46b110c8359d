// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "serve/confined_folder.h"

namespace treefarm {

/// What a reader has to know beside the files, to tell a render that lives from one that was killed.
struct Here {
    std::int64_t now = 0;                  ///< Unix seconds
    std::string host;                      ///< this machine's name
    std::function<bool(int)> has_process;  ///< whether a process of this machine lives, by its number
};
Here local_host();

/// What is known of a run by its files, for the list: name, state, how far it is, its error, its picture's version.
/// A file that is missing, half there or of another program leaves its figures null. `state` is status.json's, or
/// "killed" where that says "running" and its process is gone from this machine, or "silent" where it has said nothing
/// for a minute, or "unknown".
nlohmann::ordered_json run_entry(const ConfinedFolder& root, const std::string& path, const Here& here);

/// run_entry(), with everything else that the page of a run shows: workers, forecasts, passes, the end of the log, how
/// it ended, its supervisor's state.
nlohmann::ordered_json run_view(const ConfinedFolder& root, const std::string& path, const Here& here);

}  // namespace treefarm
