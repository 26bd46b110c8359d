// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/launch_run.h"
#include "coordinator/launch/host_pool.h"
#include "coordinator/launch/start_command.h"

namespace treefarm {

/// Decides how attempts are started on this machine, or these hosts, or this Slurm allocation.
class LaunchPlanner {
  public:
    /// Throws InputError where nothing could be started.
    explicit LaunchPlanner(const LaunchOptions& options);

    /// Files and folders of an attempt.
    struct LaunchPaths {
        std::filesystem::path hostfile, temporary, shared_memory;
    };
    /// How the next attempt is started; asks hosts whether they answer, and writes a hostfile of those that do. Throws
    /// RunError where none is left.
    StartPlan plan(const LaunchPaths& paths) const;

    /// An attempt has ended, and its coordinator had these workers.
    void note_end(const std::vector<LifeWorker>& workers);

    /// One process, without mpirun.
    bool stands_alone() const { return starter_ == Starter::alone; }

  private:
    Starter choose_starter() const;
    void use_hosts(const LaunchPaths& paths, StartPlan& plan) const;

    const LaunchOptions& options_;
    std::optional<HostPool> hosts_;
    Starter starter_;
};

}  // namespace treefarm
