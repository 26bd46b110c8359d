// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/launch/launched_command.h"

namespace treefarm {

/// treefarm launch
struct LaunchOptions {
    int processes = 0;                 ///< -n; 0: as many as the hosts, or the allocation, ask for
    std::string hostfile;              ///< --hostfile
    int restarts = 5;                  ///< --restarts
    double stall_seconds = 300;        ///< --stall-seconds
    bool no_recovery = false;          ///< --no-recovery
    std::string network;               ///< --network
    std::string mpirun = "mpirun";     ///< --mpirun
    bool sweep = false;                ///< --sweep
    std::vector<std::string> command;  ///< behind "--"
};

/// Keeps `command`, which stands in `options` as words, alive until it has ended, and returns its exit code. Throws
/// InputError.
int run_launch(const LaunchOptions& options, LaunchedCommand command);

}  // namespace treefarm
