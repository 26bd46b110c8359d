// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "cli/launch_environment.h"
#include "common/base/console.h"
#include "coordinator/render/render_request.h"

namespace CLI {
class App;
}

namespace treefarm {

/// Result of the coordinator's part.
struct CoordinatorEnd {
    int code = 0;        ///< exit code
    std::set<int> lost;  ///< workers that were given up
};

/// The coordinator's part of a command, between the start of the workers and their dismissal.
struct FarmTask {
    std::function<void()> prepare;  ///< reads and checks the input; without mpirun a signal interrupts it
    std::function<CoordinatorEnd(const RenderWorkers&)> coordinate;
};

/// Options for running a command on a farm.
struct FarmOptions {
    unsigned threads = 0;         ///< tracing threads of each worker; 0: its processors
    bool quiet = false;           ///< only errors on the terminal
    bool verbose = false;         ///< every figure of each pass
    double start_seconds = 25.0;  ///< limit for all processes of an MPI job to come together
};

/// Adds --threads, --quiet, --verbose
void add_log_options(CLI::App& command, FarmOptions& options);
/// Adds --threads, --quiet, --verbose, --start-seconds
void add_farm_options(CLI::App& command, FarmOptions& options);

/// Console output of this process: its stream and verbosity.
struct LogOutput {
    ConsolePtr console;
    Verbosity verbosity = Verbosity::normal;
};
LogOutput make_log_output(const LaunchEnvironment& launch, const FarmOptions& options);

/// Output of errors only, without a status line.
LogOutput errors_only();

/// Worker in this process. `threads`: 0: its processors.
LocalWorker local_worker(unsigned threads, const LogOutput& log_output);

/// Runs the task over all processes of the MPI job, or as coordinator and one worker in this process. Returns the exit
/// code; InputError and RunError leave it in one process only.
int run_on_farm(const LaunchEnvironment& launch, const FarmOptions& options, const LogOutput& log_output,
                const FarmTask& task);

/// Adds a warning if there are more threads than processors.
void warn_if_crowded(unsigned threads, std::vector<std::string>& warnings);

}  // namespace treefarm
