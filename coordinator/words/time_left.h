// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "coordinator/passes/pass_loop.h"

namespace treefarm {

/// How long a render still takes.
struct TimeLeft {
    double seconds = std::numeric_limits<double>::infinity();  ///< infinite: not known
    const char* trust = "";                                    ///< "about ", "at most "; empty: for sure
    bool known() const { return seconds < std::numeric_limits<double>::infinity(); }
};

/// Tells how long a render still takes, as its budget ends it. Between two finished units of work the time runs down:
/// nothing new is known. Where it has run out and the render goes on, it is not known any more.
class TimeLeftClock {
  public:
    explicit TimeLeftClock(const Job::Budget& budget) : budget_(budget) {}
    TimeLeft at(const RenderProgress& progress);

  private:
    TimeLeft by_samples(const RenderProgress& progress);

    const Job::Budget budget_;
    double fraction_ = 0;  ///< of all samples, when the last unit was finished
    double seconds_ = 0;   ///< time when the last unit was finished
};

}  // namespace treefarm
