// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Processor time of one worker over the passes of a render, for a warning if its threads got too little of it.
class ProcessorTime {
  public:
    /// Adds a pass: thread-seconds with a unit, and those of them with a processor. Returns the warning, once, when the
    /// worker has been busy for ten thread-seconds with less than half of its processors; otherwise "".
    std::string add(int worker, double busy_seconds, double core_seconds);

  private:
    double busy_ = 0, core_ = 0;
    bool told_ = false;
};

}  // namespace treefarm
