#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace treefarm {

/// How long to give up the processor when nothing arrives: first a yield, then sleeps that double. Keeps an idle
/// coordinator under one hundredth of a core without making a busy one late.
class IdlePause {
  public:
    /// Something happened: be quick again.
    void reset() { quiet_ = 0; }

    /// Sleeps at most `seconds`; shorter while a transfer is `moving`, since it only moves when it is looked at.
    void rest(double seconds, bool moving) {
        if (++quiet_ <= kYields) {
            std::this_thread::yield();
            return;
        }
        const double longest = std::min(seconds, moving ? kMovingSeconds : kLongestSeconds);
        const int doublings = std::min(quiet_ - kYields, 10);
        std::this_thread::sleep_for(
            std::chrono::duration<double>(std::min(longest, kShortestSeconds * static_cast<double>(1 << doublings))));
    }

  private:
    static constexpr int kYields = 16;
    static constexpr double kShortestSeconds = 20e-6;
    static constexpr double kMovingSeconds = 200e-6;
    static constexpr double kLongestSeconds = 2e-3;
    int quiet_ = 0;
};

}  // namespace treefarm
