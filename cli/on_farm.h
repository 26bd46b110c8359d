// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "cli/launch.h"
#include "common/base/console.h"
#include "common/comm/channel.h"

namespace CLI {
class App;
}

namespace treefarm {

/// How the coordinator's part ended.
struct CoordinatorEnd {
    int code = 0;        ///< exit code
    std::set<int> lost;  ///< workers that were given up
};

/// The coordinator's part, between the start of the workers and their dismissal.
struct FarmTask {
    std::function<void()> prepare;  ///< reads and checks the input; without mpirun a signal breaks it off
    std::function<CoordinatorEnd(Channel&, const std::function<bool()>& interrupted)> coordinate;
};

/// How this program's part in the farm is run.
struct FarmOptions {
    unsigned threads = 0;         ///< that trace in each worker; 0: its processors
    bool quiet = false;           ///< only errors on the terminal
    bool verbose = false;         ///< every figure of each pass
    double start_seconds = 25.0;  ///< in which all processes of an MPI job have to come together
};

/// --threads, --quiet, --verbose
void add_log_options(CLI::App& command, FarmOptions& options);
/// --threads, --quiet, --verbose, --start-seconds
void add_farm_options(CLI::App& command, FarmOptions& options);

/// A worker in this process, as the coordinator is told.
struct WorkerSettings;
WorkerSettings worker_settings(unsigned threads);

/// The voice of this process: where it speaks, and how much it says.
struct LogOutput {
    ConsolePtr console;
    Verbosity verbosity = Verbosity::normal;
};
LogOutput make_log_output(const LaunchEnvironment& launch, const FarmOptions& options);

/// Runs the task over all processes of the MPI job, or over coordinator and one worker in this process. Returns the
/// exit code; InputError and RunError leave it in one process only.
int run_on_farm(const LaunchEnvironment& launch, const FarmOptions& options, const LogOutput& log_output,
                const FarmTask& task);

/// Warns where more threads were asked for than processors are there.
void warn_if_crowded(unsigned threads, std::vector<std::string>& warnings);

}  // namespace treefarm
