// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "coordinator/launch/host_pool.h"
#include "coordinator/launch/launch_run.h"
#include "coordinator/launch/start_command.h"

namespace treefarm {

/// Planner of attempts on this machine, on given hosts, or in a Slurm allocation.
class LaunchPlanner {
  public:
    /// Throws InputError if nothing could be started.
    explicit LaunchPlanner(const LaunchOptions& options);

    /// Plan of the next attempt, without its folders; probes the hosts and writes the hostfile `hostfile` of those that
    /// answer. Throws RunError if none does.
    StartPlan plan(const std::filesystem::path& hostfile) const;

    /// Records the end of an attempt with its workers.
    void note_end(const std::vector<LifeWorker>& workers);

    /// Whether attempts are one process, without mpirun.
    bool stands_alone() const { return starter_ == Starter::alone; }

  private:
    Starter choose_starter() const;
    void use_hosts(const std::filesystem::path& hostfile, StartPlan& plan) const;

    const LaunchOptions& options_;
    std::optional<HostPool> hosts_;
    Starter starter_;
};

}  // namespace treefarm
