// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace treefarm {

/// How far an attempt came, as far as it is kept or was seen.
struct AttemptReach {
    std::uint64_t checkpoint = 0;  ///< generation of the newest on disk
    std::uint64_t passes = 0;      ///< finished, in all lives of the render
    std::uint64_t renders = 0;     ///< of a series, that this attempt has finished
};

/// Counts restarts that brought nothing: an attempt that came farther than any before it begins the count anew.
class RestartCount {
  public:
    /// `fruitless`: so many restarts in a row may bring nothing.
    RestartCount(int fruitless, int all) : most_fruitless_(fruitless), most_(all) {}

    /// An attempt has died at a place, "pass 3". Returns whether there may be another one.
    bool died(const AttemptReach& reach, const std::string& stage);

    /// Seconds until the next attempt: 1, 2, 4, ... 30.
    double pause() const;
    /// Attempts in a row, the last included, that brought nothing after the first of them.
    int in_a_row() const { return static_cast<int>(stages_.size()); }
    /// The place where all of them died; "" if they are several.
    std::string common_stage() const;

  private:
    const int most_fruitless_, most_;
    int all_ = 0;
    AttemptReach best_;
    std::vector<std::string> stages_;  ///< of deaths since the last progress
};

}  // namespace treefarm
