// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/launch/launched_command.h"

namespace treefarm {

/// Options of treefarm launch
struct LaunchOptions {
    int processes = 0;                 ///< -n; 0: the number that the hosts, or the allocation, imply
    std::string hostfile;              ///< --hostfile
    int restarts = 5;                  ///< --restarts
    double stall_seconds = 300;        ///< --stall-seconds
    bool no_recovery = false;          ///< --no-recovery
    std::string network;               ///< --network
    std::string mpirun = "mpirun";     ///< --mpirun
    bool sweep = false;                ///< --sweep
    std::vector<std::string> command;  ///< the words after "--"
};

/// Supervises `command`, the parsed form of `options.command`, until it has ended, and returns its exit code. Throws
/// InputError.
int run_launch(const LaunchOptions& options, LaunchedCommand command);

}  // namespace treefarm
