// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// Starter of an attempt's processes.
enum class Starter {
    alone,   ///< one process, without MPI
    mpirun,  ///< Open MPI's
    srun,    ///< Slurm's, with PMIx
};

struct StartPlan {
    Starter starter = Starter::mpirun;
    std::string mpirun = "mpirun";
    std::string program;  ///< path of this program, equal on all hosts
    int processes = 1;
    bool one_host = true;                   ///< if there is no hostfile: mpirun then knows no other host
    bool no_agent = false;                  ///< there is no ssh, without which mpirun refuses even one host
    bool recovery = true;                   ///< a rank that dies does not end the others
    std::filesystem::path hostfile{};       ///< empty: this host, or those of a Slurm allocation
    bool oversubscribed = false;            ///< more processes than the hostfile has slots
    std::string network{};                  ///< network for Open MPI, "10.0.0.0/24"; empty: its choice
    std::filesystem::path temporary{};      ///< folder for Open MPI's own files
    std::filesystem::path shared_memory{};  ///< folder for shared memory of this host's ranks; empty: the usual one
    std::vector<HostLine> hosts{};          ///< hosts of the hostfile
    std::vector<std::string> warnings{};    ///< hosts left out, and the crowding that follows
};

/// Environment variable that passes StartPlan::warnings to the coordinator's log.
inline constexpr const char* kWarningsVariable = "TREEFARM_LAUNCH_WARNINGS";

/// Command that starts the program with the arguments `words`.
std::vector<std::string> start_command(const StartPlan& plan, const std::vector<std::string>& words);

}  // namespace treefarm
