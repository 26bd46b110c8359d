// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace treefarm {

/// Progress of a task, for a person.
struct Status {
    double fraction = -1;             ///< part done, 0 to 1; negative: unknown, no bar is shown
    std::vector<std::string> fields;  ///< shown after the bar, the most important first
    std::size_t essential = 2;        ///< number of leading fields that matter more than the bar
    std::string line;                 ///< bar and fields as a sentence, for outputs that cannot redraw
};

/// Bar and fields in at most `columns` columns. If they do not fit, the last fields are dropped first, then the bar,
/// then essential fields from the right.
std::string status_text(const Status& status, int columns);

/// The fields that are not empty, joined with spaces.
std::string join_fields(const std::vector<std::string>& fields);

/// Schedule of progress messages: after `first` seconds, then every `apart` seconds.
class StatusPace {
  public:
    StatusPace(double first, double apart) : next_(first), apart_(apart) {}
    /// Whether a message is due `now` seconds after the start; true once per interval.
    bool due(double now) {
        if (now < next_) return false;
        next_ = now + apart_;
        return true;
    }

  private:
    double next_;
    double apart_;
};

}  // namespace treefarm
