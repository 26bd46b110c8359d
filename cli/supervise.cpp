// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/read_launched_command.h"
#include "common/base/error.h"
#include "coordinator/launch/launch_run.h"
#include "coordinator/launch/sweep.h"

namespace treefarm {

namespace {

int launch_or_sweep(const LaunchOptions& options, const LaunchEnvironment& launch) {
    if (launch.under_mpi)
        throw InputError(Location{"launch", 0, 0}, "was itself started by mpirun or srun, which it would start",
                         "leave them away: treefarm launch -n 3 -- render scene.xml");
    if (!options.sweep) return run_launch(options, read_launched_command(options.command));
    if (!options.command.empty())
        throw InputError(Location{"--sweep", 0, 0}, "launches nothing", "leave the command away");
    std::cout << sweep() << " left by dead processes removed\n";
    return 0;
}

}  // namespace

void add_launch_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<LaunchOptions>();
    CLI::App* command = app.add_subcommand("launch", "Keeps a render alive: starts it, watches it, starts it again");
    command->add_option("command", options->command, "behind --: render, resume or study with its options")
        ->expected(-1);
    add_integer_option(*command, "-n", options->processes, {1, 1e5, "processes", "9"},
                       "processes, one of which coordinates (default: a worker for each host of --hostfile, the tasks "
                       "of a Slurm allocation, or one process without mpirun)");
    add_text_option(*command, "--hostfile", options->hostfile,
                    "hosts, as mpirun takes them; those that answer are used");
    add_integer_option(*command, "--restarts", options->restarts, {0, 1e3, "restarts", "5"},
                       "in a row without progress, after which launch gives up (default: 5)");
    add_number_option(*command, "--stall-seconds", options->stall_seconds, {10, 1e6, "seconds", "600"},
                      "without progress, after which a running render is restarted (default: 300)");
    command->add_flag("--no-recovery", options->no_recovery,
                      "let the death of a worker end mpirun: the render goes on from its checkpoint");
    add_text_option(*command, "--network", options->network, "network that Open MPI uses between hosts: 10.0.0.0/24");
    add_text_option(*command, "--mpirun", options->mpirun, "Open MPI's mpirun (default: the one in PATH)");
    command->add_flag(
        "--sweep", options->sweep,
        "only remove files that dead processes of yours have left in /dev/shm and the folder for temporary "
        "files");
    command->footer(std::string("treefarm launch -n 3 -- render scene.xml\n") + kExitCodesText);
    command->callback([options, launch, &exit_code] { exit_code = launch_or_sweep(*options, launch); });
}

}  // namespace treefarm
