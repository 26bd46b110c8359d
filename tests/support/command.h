// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm::test {

/// Result of a command.
struct Ended {
    int code = -1;       ///< -1: killed, or not started
    std::string output;  ///< standard output and error
};

/// Runs a shell command.
Ended run_command(const std::string& command);

/// Runs treefarm with these arguments.
Ended run_treefarm(const std::string& arguments);

}  // namespace treefarm::test
