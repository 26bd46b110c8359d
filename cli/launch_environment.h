// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "common/base/terminal.h"
#include "coordinator/run/sign_of_life.h"

namespace treefarm {

/// Launcher of this process, from its environment variables, which are read only here.
struct LaunchEnvironment {
    bool under_mpi = false;  ///< by mpirun or srun --mpi=pmix
    int rank = 0;            ///< rank in the job; 0 without a launcher
    int size = 0;            ///< processes of the job; 0: unknown
    bool one_host = false;   ///< mpirun started all processes on this host
    bool in_slurm = false;   ///< in a Slurm job, whatever started it there
    /// number of tasks that MPI cannot connect, so that each is an MPI world of its own; 1: none
    int lone_tasks = 1;
    int lone_task = 0;                 ///< number of this task among them
    bool by_slurm = false;             ///< they were started by srun
    TerminalKind terminal;             ///< of standard error; nothing is drawn under mpirun
    std::shared_ptr<SignOfLife> life;  ///< heartbeat of a coordinator that treefarm launch started; else nullptr
    std::string warnings;              ///< of treefarm launch, for the render's log: hosts that it left out
    std::filesystem::path key_file;    ///< key file, for processes that treefarm launch started; else empty
};
LaunchEnvironment read_launch_environment();

/// Whether this is one of several unconnected tasks, which would all render the same into one folder. The first of them
/// throws InputError with the command to use; the others need only leave.
bool is_separate_world(const LaunchEnvironment& launch);

/// Skips Open MPI's search for fast networks, for processes of one host; to be called before MPI starts. The search
/// takes time and ends with shared memory (ob1). The environment and mpirun's options take precedence.
void skip_network_search();

}  // namespace treefarm
