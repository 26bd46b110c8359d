#include "cli/launch.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace treefarm {

namespace {

/// NO_COLOR: no-color.org. A terminal without a name, or a dumb one, understands no escape sequences.
TerminalKind read_terminal(bool under_mpi) {
    const char* const name = std::getenv("TERM");
    const char* const no_colour = std::getenv("NO_COLOR");
    TerminalKind terminal;
    terminal.live = !under_mpi && isatty(STDERR_FILENO) && name && *name && std::string_view(name) != "dumb";
    terminal.colour = terminal.live && !(no_colour && *no_colour);
    return terminal;
}

}  // namespace

LaunchEnvironment read_launch_environment() {
    LaunchEnvironment launch;
    for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK"})
        if (const char* rank = std::getenv(name)) {
            launch.under_mpi = true;
            launch.rank = std::atoi(rank);
            break;
        }
    const char* const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    const char* const all = std::getenv("OMPI_COMM_WORLD_SIZE");
    launch.one_host = here && all && std::string_view(here) == all;
    launch.terminal = read_terminal(launch.under_mpi);
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

std::string host_name() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

}  // namespace treefarm
