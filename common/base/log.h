#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>

namespace treefarm {

using Log = std::shared_ptr<spdlog::logger>;

/// A log that writes to the terminal (standard error; unless quiet) and, where `file` is not empty, to a file.
/// `who` stands at the start of each line: "coordinator", "worker 3".
Log make_log(const std::string& who, const std::filesystem::path& file, bool quiet);

}  // namespace treefarm
