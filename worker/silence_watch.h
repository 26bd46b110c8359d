// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace treefarm {

/// Timer of the coordinator's silence, limited to the time in which this process could have received messages.
class SilenceWatch {
  public:
    /// `limit_seconds`: silence after which the coordinator counts as lost.
    explicit SilenceWatch(double limit_seconds) : limit_(limit_seconds) {}

    /// Receipt of any message: restarts the timer.
    void broken() { seconds_ = 0; }

    /// Advances the timer to `now`, once per turn of the loop; true if the silence exceeds the limit. A long turn
    /// counts as a short one: while stopped or starved, the process could receive nothing.
    bool too_long(double now) {
        constexpr double kLongestTurnSeconds = 0.5;
        seconds_ += std::min(now - turned_, kLongestTurnSeconds);
        turned_ = now;
        return seconds_ > limit_;
    }

    /// Raises the limit, for a coordinator with longer heartbeat intervals.
    void allow(double seconds) { limit_ = std::max(limit_, seconds); }

    double seconds() const { return seconds_; }

  private:
    double limit_;
    double seconds_ = 0, turned_ = 0;
};

}  // namespace treefarm
