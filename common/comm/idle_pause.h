// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace treefarm {

/// Pause of a polling loop when nothing arrives: at first none, then sleeps of doubling length. An idle coordinator
/// stays below one hundredth of a core, and a busy one is not delayed. It does not yield: with more threads than
/// processors that can last a time slice of 4 ms; a short sleep does not.
class IdlePause {
  public:
    /// Reports activity: the next pauses are short again.
    void reset() { quiet_ = 0; }

    /// Sleeps at most `seconds`; less while a transfer is `moving`, since it advances only when polled.
    void rest(double seconds, bool moving) {
        if (++quiet_ <= kLooks) return;
        const double longest = std::min(seconds, moving ? kMovingSeconds : kLongestSeconds);
        const int doublings = std::min(quiet_ - kLooks, 10);
        std::this_thread::sleep_for(
            std::chrono::duration<double>(std::min(longest, kShortestSeconds * static_cast<double>(1 << doublings))));
    }

  private:
    static constexpr int kLooks = 8;  ///< polls without a pause, some microseconds in all
    static constexpr double kShortestSeconds = 20e-6;
    static constexpr double kMovingSeconds = 200e-6;
    static constexpr double kLongestSeconds = 2e-3;
    int quiet_ = 0;
};

}  // namespace treefarm
