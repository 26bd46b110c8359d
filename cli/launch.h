#pragma once

#include <string>

#include "common/base/terminal.h"

namespace treefarm {

/// How this process was started, as the launcher's environment says. The only place that reads the environment.
struct LaunchEnvironment {
    bool under_mpi = false;  ///< by mpirun or srun --mpi=pmix
    int rank = 0;            ///< what the launcher calls this process; 0 without a launcher
    bool one_host = false;   ///< mpirun started all processes on this host
    TerminalKind terminal;   ///< standard error; nothing is drawn through mpirun
};
LaunchEnvironment read_launch_environment();

/// For processes of one host, before MPI starts: Open MPI's search for fast networks takes 0.2 s, and ends with shared
/// memory (ob1). Unless the environment or an option of mpirun chose something else.
void skip_network_search();

/// Processors that this process may run on.
unsigned affinity_threads();

/// Processors of this host.
unsigned host_processors();

std::string host_name();

}  // namespace treefarm
