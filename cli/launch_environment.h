// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "common/base/terminal.h"
#include "coordinator/run/sign_of_life.h"

namespace treefarm {

/// How this process was started, as the launcher's environment says. The only place that reads the environment.
struct LaunchEnvironment {
    bool under_mpi = false;  ///< by mpirun or srun --mpi=pmix
    int rank = 0;            ///< what the launcher calls this process; 0 without a launcher
    int size = 0;            ///< processes of the job; 0: not known
    bool one_host = false;   ///< mpirun started all processes on this host
    bool in_slurm = false;   ///< in a job of Slurm, whoever started it there
    int lone_tasks = 1;      ///< more than 1: of a launcher that MPI cannot talk to, so each is an MPI world of its own
    int lone_task = 0;       ///< which of them this is
    bool by_slurm = false;   ///< they were started by srun
    TerminalKind terminal;   ///< standard error; nothing is drawn through mpirun
    std::shared_ptr<SignOfLife> life;  ///< of a coordinator that treefarm launch started; else nullptr
    std::filesystem::path key_file;    ///< of processes that treefarm launch started; else empty
};
LaunchEnvironment read_launch_environment();

/// Whether this is one of several tasks that would all render the same into one folder. The first of them throws
/// InputError with what to type; the others need only leave.
bool is_separate_world(const LaunchEnvironment& launch);

/// Skips Open MPI's search for fast networks, for processes of one host and before MPI starts: it takes time, and ends
/// with shared memory (ob1). Unless the environment or an option of mpirun chose something else.
void skip_network_search();

/// Processors that this process may run on.
unsigned affinity_threads();

/// Processors of this host.
unsigned host_processors();

}  // namespace treefarm
