// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace treefarm {

/// How long to give up the processor when nothing arrives: first not at all, then sleeps that double. Keeps an idle
/// coordinator under one hundredth of a core without making a busy one late. It never yields: where threads outnumber
/// processors that may last a time slice of 4 ms, and a short sleep does not.
class IdlePause {
  public:
    /// Something happened: be quick again.
    void reset() { quiet_ = 0; }

    /// Sleeps at most `seconds`; shorter while a transfer is `moving`, since it only moves when it is looked at.
    void rest(double seconds, bool moving) {
        if (++quiet_ <= kLooks) return;
        const double longest = std::min(seconds, moving ? kMovingSeconds : kLongestSeconds);
        const int doublings = std::min(quiet_ - kLooks, 10);
        std::this_thread::sleep_for(
            std::chrono::duration<double>(std::min(longest, kShortestSeconds * static_cast<double>(1 << doublings))));
    }

  private:
    static constexpr int kLooks = 8;  ///< in a row, some microseconds
    static constexpr double kShortestSeconds = 20e-6;
    static constexpr double kMovingSeconds = 200e-6;
    static constexpr double kLongestSeconds = 2e-3;
    int quiet_ = 0;
};

}  // namespace treefarm
