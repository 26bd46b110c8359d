// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>

#include "common/base/console.h"

namespace treefarm {

using Log = std::shared_ptr<spdlog::logger>;

/// A log that writes to the console, as much as `loudness` says, and, where `file` is not empty, everything to a file:
/// in a thread of its own, that has written all when the log ends.
/// `who` ("treefarm", "worker 3") stands before warnings and errors; plain information stands alone.
Log make_log(const std::string& who, const std::filesystem::path& file, const ConsolePtr& console, Verbosity verbosity);

}  // namespace treefarm
