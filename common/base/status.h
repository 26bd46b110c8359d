// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace treefarm {

/// How far something is, for a person.
struct Status {
    double fraction = -1;             ///< done; negative: not known, so there is no bar
    std::vector<std::string> fields;  ///< behind the bar, the most important first
    std::size_t essential = 2;        ///< so many fields matter more than the bar
    std::string line;                 ///< bar and fields as a whole line, where nothing can be drawn again
};

/// Bar and fields in at most so many columns. As it gets narrow, the last fields go, then the bar, then essential
/// fields, from the right.
std::string status_text(const Status& status, int columns);

/// Fields with the space that stands between them; empty ones are left out.
std::string join_fields(const std::vector<std::string>& fields);

/// When to say again how far something is: after `first` seconds, then every `apart` seconds.
class StatusPace {
  public:
    StatusPace(double first, double apart) : next_(first), apart_(apart) {}
    /// Whether it is time to say so, `now` seconds after the start. Once it was, it is not again for a while.
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
