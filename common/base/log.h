// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "common/base/console.h"

namespace treefarm {

using Log = std::shared_ptr<spdlog::logger>;

enum class MessageLevel { detail, info, warning, error };

/// Takes the lines of a log, each without line end and control characters. May be empty.
using TellMessage = std::function<void(MessageLevel, const std::string&)>;

/// A log that passes its lines to `tell` and, if `file` is not empty, writes them to the file in a separate thread. All
/// are written when the log ends. `who`: prefix of each line in the file.
Log make_log(const std::string& who, const std::filesystem::path& file, const TellMessage& tell);

/// Writes lines to the console, as many as `verbosity` allows. `who` ("treefarm", "worker 3") is the prefix of warnings
/// and errors; plain information has none.
TellMessage console_messages(const std::string& who, const ConsolePtr& console, Verbosity verbosity);

/// A log that writes to the console, as much as `verbosity` allows, and everything to a file, if one is named.
Log make_log(const std::string& who, const std::filesystem::path& file, const ConsolePtr& console, Verbosity verbosity);

}  // namespace treefarm
