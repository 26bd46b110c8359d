#pragma once

#include <string>

namespace treefarm {

/// How this process was started, as the launcher's environment says. The only place that reads the environment.
struct LaunchEnvironment {
    bool under_mpi = false;  ///< by mpirun or srun --mpi=pmix
    int rank = 0;            ///< what the launcher calls this process; 0 without a launcher
};
LaunchEnvironment read_launch_environment();

/// Processors that this process may run on.
unsigned affinity_threads();

/// Processors of this host.
unsigned host_processors();

std::string host_name();

}  // namespace treefarm
