// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>

#include "common/base/console.h"

namespace treefarm {

using Log = std::shared_ptr<spdlog::logger>;

/// Log to the console, limited by `verbosity`, and, if `file` is not empty, completely to a file. The file is written
/// by a thread of its own, which has written everything when the log is destroyed. `who` ("treefarm", "worker 3")
/// prefixes warnings and errors, not plain information.
Log make_log(const std::string& who, const std::filesystem::path& file, const ConsolePtr& console, Verbosity verbosity);

}  // namespace treefarm
