// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace treefarm {

/// How long the coordinator has been silent, as far as this process could have heard it.
class SilenceWatch {
  public:
    /// `limit_seconds`: a coordinator silent for so long is gone.
    explicit SilenceWatch(double limit_seconds) : limit_(limit_seconds) {}

    /// Something was heard.
    void broken() { seconds_ = 0; }

    /// Called every turn of the loop, with the time. While the process was stopped, or starved, nobody could be heard:
    /// long turns count as short ones.
    bool too_long(double now) {
        constexpr double kLongestTurnSeconds = 0.5;
        seconds_ += std::min(now - turned_, kLongestTurnSeconds);
        turned_ = now;
        return seconds_ > limit_;
    }

    /// A coordinator that speaks more rarely may be silent for longer.
    void allow(double seconds) { limit_ = std::max(limit_, seconds); }

    double seconds() const { return seconds_; }

  private:
    double limit_;
    double seconds_ = 0, turned_ = 0;
};

}  // namespace treefarm
