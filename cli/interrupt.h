// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

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

  private:
    bool has_come(const sigset_t& signals);

    sigset_t watched_;
    bool seen_ = false;
};

}  // namespace treefarm
