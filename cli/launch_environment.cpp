// SPDX-License-Identifier: Apache-2.0
#include "cli/launch_environment.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "common/base/environment.h"
#include "common/base/error.h"
#include "common/comm/run_key.h"
#include "coordinator/launch/host_keys.h"
#include "coordinator/launch/start_command.h"

namespace treefarm {

namespace {

/// Finds tasks that Open MPI cannot connect: srun without PMIx or with PMI-2, and MPICH's mpiexec, number tasks in
/// variables that it does not read. In a batch script SLURM_PROCID is set, too, but no step.
void find_lone_tasks(LaunchEnvironment& launch) {
    if (is_set("PMI_RANK") && number_in("PMI_SIZE") > 1) {
        launch.lone_tasks = number_in("PMI_SIZE");
        launch.lone_task = number_in("PMI_RANK");
    } else if (const char* kind = std::getenv("ENVIRONMENT");
               is_set("SLURM_PROCID") && (is_set("SLURM_STEP_ID") || !kind || std::string_view(kind) != "BATCH")) {
        const int tasks = number_in(is_set("SLURM_STEP_NUM_TASKS") ? "SLURM_STEP_NUM_TASKS" : "SLURM_NTASKS");
        launch.lone_tasks = std::max(1, tasks);
        launch.lone_task = number_in("SLURM_PROCID");
    }
    launch.by_slurm = is_set("SLURM_PROCID");
}

/// Capabilities of the terminal. NO_COLOR: no-color.org. A terminal without a name, or a dumb one, has no escape
/// sequences.
TerminalKind read_terminal(bool under_mpi) {
    const char* const name = std::getenv("TERM");
    TerminalKind terminal;
    terminal.live = !under_mpi && isatty(STDERR_FILENO) && name && *name && std::string_view(name) != "dumb";
    terminal.colour = terminal.live && !is_set("NO_COLOR");
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
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"})
        if (const char* size = std::getenv(name); size && launch.under_mpi) {
            launch.size = std::atoi(size);
            break;
        }
    const char* const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    const char* const all = std::getenv("OMPI_COMM_WORLD_SIZE");
    launch.in_slurm = is_set("SLURM_JOB_ID");
    launch.one_host = here && all && std::string_view(here) == all;
    // an interactive shell does not start many tasks
    if (!launch.under_mpi && !isatty(STDIN_FILENO)) find_lone_tasks(launch);
    launch.terminal = read_terminal(launch.under_mpi);
    if (const char* text = std::getenv(kWarningsVariable)) launch.warnings = text;
    if (const char* text = std::getenv(kAttemptVariable))
        if (const LifeAttempt attempt = parse_attempt(text); !attempt.name.empty()) {
            launch.key_file = attempt.file.parent_path() / kRunKeyName;
            const std::filesystem::path on_host = host_key_file(attempt.name);
            if (!std::filesystem::exists(launch.key_file) && std::filesystem::exists(on_host))
                launch.key_file = on_host;
            if (launch.rank == 0) launch.life = std::make_shared<SignOfLife>(attempt);
        }
    return launch;
}

bool is_separate_world(const LaunchEnvironment& launch) {
    if (launch.lone_tasks <= 1) return false;
    if (launch.lone_task > 0) return true;
    const std::string count = std::to_string(launch.lone_tasks);
    throw InputError(Location{launch.by_slurm ? "srun" : "mpiexec", 0, 0},
                     "started " + count + " unconnected tasks: each would render everything, into the same folder",
                     launch.by_slurm ? "write srun --mpi=pmix treefarm ..., or, in an allocation, mpirun -n " + count +
                                           " treefarm ...; to render in one process, srun -n 1"
                                     : "use Open MPI's: mpirun -n " + count + " treefarm ...");
}

void skip_network_search() {
    setenv("OMPI_MCA_pml", "ob1", /*overwrite=*/0);
}

}  // namespace treefarm
