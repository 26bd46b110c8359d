// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

#include <vector>

namespace treefarm {

/// Signals of a supervisor as a descriptor to wait for, blocked for this process; no handler, no global state. One that
/// was ignored before stays so: nohup.
class LaunchSignals {
  public:
    LaunchSignals();
    ~LaunchSignals();
    LaunchSignals(const LaunchSignals&) = delete;
    LaunchSignals& operator=(const LaunchSignals&) = delete;

    int descriptor() const { return descriptor_; }
    /// Numbers of those that have come since the last call.
    std::vector<int> take();

  private:
    int descriptor_;
    sigset_t before_;
};

}  // namespace treefarm
