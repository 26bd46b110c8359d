// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// How the processes of an attempt are started.
enum class Starter {
    alone,   ///< one process, without MPI
    mpirun,  ///< Open MPI's
    srun,    ///< Slurm's, with PMIx
};

struct StartPlan {
    Starter starter = Starter::mpirun;
    std::string mpirun = "mpirun";
    std::string program;  ///< this one's path, on all hosts
    int processes = 1;
    bool one_host = true;                   ///< without a hostfile: mpirun itself knows no other
    bool recovery = true;                   ///< a rank that dies does not end the others
    std::filesystem::path hostfile{};       ///< empty: this host, or those of a Slurm allocation
    bool oversubscribed = false;            ///< more processes than the hostfile has slots
    std::string network{};                  ///< that Open MPI is to use, "10.0.0.0/24"; empty: its choice
    std::filesystem::path temporary{};      ///< folder for Open MPI's own files
    std::filesystem::path shared_memory{};  ///< folder for memory that ranks of this host share; empty: the usual one
    std::vector<HostLine> hosts{};          ///< hosts of the hostfile
};

/// The command that starts `words`, the program's arguments.
std::vector<std::string> start_command(const StartPlan& plan, const std::vector<std::string>& words);

}  // namespace treefarm
