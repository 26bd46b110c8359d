// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace treefarm {

/// Progress of an attempt, as far as it is stored or was observed.
struct AttemptReach {
    std::uint64_t checkpoint = 0;  ///< newest generation on disk
    std::uint64_t passes = 0;      ///< finished passes, including those before a resume
    std::uint64_t renders = 0;     ///< finished renders of this attempt, in a series
};

/// Counter of restarts without progress: an attempt with more progress than any before it resets the count.
class RestartCount {
  public:
    /// `fruitless`: allowed restarts in a row without progress; `all`: allowed restarts in total.
    RestartCount(int fruitless, int all) : most_fruitless_(fruitless), most_(all) {}

    /// Records the death of an attempt at `place`, as "pass 3". Returns whether another one is allowed.
    bool died(const AttemptReach& reach, const std::string& stage);

    /// Seconds until the next attempt: 1, 2, 4, ... 30.
    double pause() const;
    /// Number of attempts in a row without progress since the first of them, the last one included.
    int in_a_row() const { return static_cast<int>(stages_.size()); }
    /// Point at which all of them died; "" if there are several.
    std::string common_stage() const;

  private:
    const int most_fruitless_, most_;
    int all_ = 0;
    AttemptReach best_;
    std::vector<std::string> stages_;  ///< points of death since the last progress
};

}  // namespace treefarm
