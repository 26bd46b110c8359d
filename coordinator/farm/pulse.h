// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/base/timer.h"
#include "common/comm/channel.h"

namespace treefarm {

/// Runs `work` in a thread of its own, while this thread calls `meanwhile` every few milliseconds, for communication.
/// Rethrows exceptions of either when the work has ended.
void run_in_background(const std::function<void()>& work, const std::function<void()>& meanwhile);

/// Coordinator's heartbeat to workers while there is no farm: before the job is known, and between two jobs.
class Pulse {
  public:
    explicit Pulse(Channel& channel) : channel_(channel) {}

    /// Sends the heartbeat to every worker once a second, however often it is called.
    void beat();

  private:
    Channel& channel_;
    const Timer clock_;
    double last_ = -1e9;
};

}  // namespace treefarm
