// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/types.h>

namespace treefarm {

/// A reader that closes (`treefarm render ... | head`) ends nothing from now on: writing to it fails instead.
void ignore_broken_pipes();

/// Whether who started this process had it ignore a signal, as nohup does.
bool is_ignored(int number);

/// SIGINT, SIGTERM, SIGHUP and SIGUSR1 (treefarm launch asks by it, through mpirun) as something to ask about. Blocks
/// them for this thread and the threads it starts from now on; no handler, no global state. A SIGHUP that was ignored
/// before stays so: nohup.
class InterruptWatch {
  public:
    InterruptWatch();
    /// True once a signal has come.
    bool interrupted();
    /// True once SIGTERM has come, whatever else: a worker does not heed the others.
    bool terminated();
    /// Whether what came was SIGTERM from the process that started this one: mpirun, when it ends a job of its own
    /// accord, since it has lost a host.
    bool told_by_parent() const { return told_by_parent_; }

  private:
    bool has_come(const sigset_t& signals);

    const pid_t parent_;
    sigset_t watched_;
    bool seen_ = false, told_by_parent_ = false;
};

}  // namespace treefarm
