#include "cli/launch.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace treefarm {

LaunchEnvironment read_launch_environment() {
    LaunchEnvironment launch;
    for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK"})
        if (const char* rank = std::getenv(name)) {
            launch.under_mpi = true;
            launch.rank = std::atoi(rank);
            break;
        }
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"})
        if (const char* size = std::getenv(name); size && launch.under_mpi) {
            launch.size = std::atoi(size);
            break;
        }
    const char* const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    const char* const all = std::getenv("OMPI_COMM_WORLD_SIZE");
    launch.one_host = here && all && std::string_view(here) == all;
    return launch;
}

void skip_network_search() {
    setenv("OMPI_MCA_pml", "ob1", /*overwrite=*/0);
}

unsigned affinity_threads() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(CPU_COUNT(&set));
    return std::max(1u, std::thread::hardware_concurrency());  // more processors than the set holds
}

unsigned host_processors() {
    return static_cast<unsigned>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
}

}  // namespace treefarm
