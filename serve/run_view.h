// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "serve/confined_folder.h"

namespace treefarm {

/// Facts besides the files that tell a live render from a killed one.
struct Here {
    std::int64_t now = 0;                  ///< Unix seconds
    std::string host;                      ///< this machine's name
    std::function<bool(int)> has_process;  ///< whether a process of this number lives on this machine
};
Here local_host();

/// Entry of a run in the list, from its files: name, state, progress, error, version of its picture. Figures of a
/// missing, incomplete or foreign file are null. `state`: that of status.json; "killed" if that is "running" and
/// its process and its lock of the folder are gone from this machine; "silent" if it was not written for a minute; or
/// "unknown".
nlohmann::ordered_json run_entry(const ConfinedFolder& root, const std::string& path, const Here& here);

/// run_entry(), with the other contents of a run's page: workers, forecasts, passes, the end of the log, how it ended,
/// its supervisor's state.
nlohmann::ordered_json run_view(const ConfinedFolder& root, const std::string& path, const Here& here);

}  // namespace treefarm
