// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/launch_environment.h"

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

/// Keeps the command alive until it has ended, and returns its exit code. Throws InputError.
int run_launch(const LaunchOptions& options);

}  // namespace treefarm
