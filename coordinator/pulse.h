// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/base/timer.h"
#include "common/comm/channel.h"

namespace treefarm {

/// Runs `work` on a thread of its own while this one, which talks, calls `meanwhile` every few milliseconds. What
/// either throws leaves this, when the work has ended.
void run_in_background(const std::function<void()>& work, const std::function<void()>& meanwhile);

/// The coordinator's sign of life where there is no farm: before it knows what to render, and between two jobs.
class Pulse {
  public:
    explicit Pulse(Channel& channel) : channel_(channel) {}

    /// Tells every worker once a second, however often it is called.
    void beat();

  private:
    Channel& channel_;
    const Timer clock_;
    double last_ = -1e9;
};

}  // namespace treefarm
