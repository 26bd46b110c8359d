// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "common/film/trace_stats.h"

namespace treefarm {

/// Timer of the phases of tracing, read once per step of a batch; costs a branch each time if profiling is off.
class PhaseClock {
  public:
    PhaseClock(bool on, TraceStats& stats) : on_(on), stats_(stats) {}

    void start() {
        if (on_) last_ = Clock::now();
    }

    /// Adds the time since start() or the last lap to `phase`.
    void lap(TracePhase phase) {
        if (!on_) return;
        const Clock::time_point now = Clock::now();
        stats_.phase_seconds[static_cast<std::size_t>(phase)] += std::chrono::duration<double>(now - last_).count();
        last_ = now;
    }

  private:
    using Clock = std::chrono::steady_clock;
    const bool on_;
    TraceStats& stats_;
    Clock::time_point last_;
};

}  // namespace treefarm
