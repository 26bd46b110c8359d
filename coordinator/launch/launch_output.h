// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "coordinator/run/life_status.h"

namespace treefarm {

/// Output of an attempt's launcher and ranks, split into lines for people and the coordinator's signs of life
/// (life_line()).
class LaunchOutput {
  public:
    /// Whole lines, printable, each with its end.
    struct Lines {
        std::string log;       ///< every line
        std::string terminal;  ///< the lines that mean something to a user
    };
    /// Takes further output and returns the lines that it completes. `is_alive`: the coordinator has given a sign of
    /// life; from then on Open MPI's words about lost processes and signals, which our own messages explain, are only
    /// for the log.
    Lines take(std::string_view part, bool is_alive);
    /// Returns the rest as a line, at the end of the output.
    Lines take_rest();

    /// Last sign of life in the output.
    const std::optional<LifeStatus>& sign() const { return sign_; }

  private:
    void add_line(std::string_view line, bool is_alive, Lines& lines);

    std::string rest_;  ///< line without an end so far
    std::optional<LifeStatus> sign_;
};

}  // namespace treefarm
