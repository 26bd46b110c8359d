// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "coordinator/passes/pass_loop.h"

namespace treefarm {

/// Forecast of a render's remaining time.
struct TimeLeft {
    double seconds = std::numeric_limits<double>::infinity();  ///< infinite: unknown
    const char* trust = "";                                    ///< "about ", "at most "; empty: certain
    bool known() const { return seconds < std::numeric_limits<double>::infinity(); }
};

/// Forecast of a render's remaining time, by the part of its budget that will end it. Between two finished units it
/// counts down; if it reaches zero and the render continues, it is unknown.
class TimeLeftClock {
  public:
    explicit TimeLeftClock(const Job::Budget& budget) : budget_(budget) {}
    TimeLeft at(const RenderProgress& progress);

  private:
    TimeLeft by_samples(const RenderProgress& progress);

    const Job::Budget budget_;
    double fraction_ = 0;  ///< fraction of all samples, when the last unit was finished
    double seconds_ = 0;   ///< time when the last unit was finished
};

}  // namespace treefarm
