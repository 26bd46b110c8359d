// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace treefarm {

/// Wall-clock seconds since construction or the last restart. Pure modules have no clock.
class Timer {
  public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    void restart() { start_ = Clock::now(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// CPU seconds used by all threads of this process.
double process_cpu_seconds();

/// CPU seconds used by the calling thread.
double thread_cpu_seconds();

}  // namespace treefarm
