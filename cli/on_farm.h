#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "cli/launch.h"
#include "common/base/console.h"
#include "common/comm/channel.h"

namespace treefarm {

/// Where this process speaks, and how much it says.
struct Voice {
    ConsolePtr console;
    Loudness loudness = Loudness::normal;
};
Voice make_voice(const LaunchEnvironment& launch, bool quiet, bool verbose);

/// How the coordinator's part ended.
struct CoordinatorEnd {
    int code = 0;        ///< exit code
    std::set<int> lost;  ///< workers that were given up
};

/// What the coordinator does, between the start of the workers and their dismissal.
struct FarmTask {
    std::function<void()> prepare;  ///< reads and checks the input; in one process a signal breaks it off
    std::function<CoordinatorEnd(Channel&, const std::function<bool()>& interrupted)> coordinate;
};

/// Runs the task over all processes of the MPI job, or over coordinator and one worker in this process. `threads`: that
/// trace in each worker, 0: its processors. Returns the exit code; InputError and RunError leave it in one process
/// only.
int run_on_farm(const LaunchEnvironment& launch, unsigned threads, const Voice& voice, const FarmTask& task);

/// Warns where more threads were asked for than processors are there.
void warn_if_crowded(unsigned threads, std::vector<std::string>& warnings);

}  // namespace treefarm
