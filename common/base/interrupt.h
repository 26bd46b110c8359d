// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/types.h>

namespace treefarm {

/// Makes writes to a closed pipe fail instead of ending this process (`treefarm render ... | head`).
void ignore_broken_pipes();

/// Makes writes beyond the limit of a file's size (`ulimit -f`) fail, as on a full disk, instead of ending this
/// process.
void ignore_size_limits();

/// Whether the parent process had a signal ignored, as nohup does.
bool is_ignored(int number);

/// Watch of the signals that ask a program to end, to be polled: SIGINT, SIGTERM, SIGHUP, SIGUSR1 (sent by treefarm
/// launch, through mpirun), SIGUSR2 and SIGALRM (sent by queues and timers before the end), SIGXCPU (`ulimit -t`).
/// Blocks them for this thread and threads that it starts later; no handler, no global state. A SIGHUP that was ignored
/// before stays ignored: nohup. SIGQUIT keeps its action, to end a program at once.
class InterruptWatch {
  public:
    InterruptWatch();
    /// Whether any of the signals has arrived.
    bool interrupted();
    /// Whether SIGTERM or SIGXCPU has arrived: a worker ignores the others.
    bool terminated();
    /// Whether the signal was SIGTERM from the parent process: mpirun sends it when it ends the job by itself after
    /// losing a host.
    bool told_by_parent() const { return told_by_parent_; }

  private:
    bool has_come(const sigset_t& signals);

    const pid_t parent_;
    sigset_t watched_;
    bool seen_ = false, told_by_parent_ = false;
};

}  // namespace treefarm
