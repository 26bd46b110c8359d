// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace treefarm::test {

/// A program that was started in a pseudo-terminal of its own; killed if the test forgets it.
class TerminalProgram {
  public:
    /// `environment`: "NAME=value" to set, "NAME" to leave out.
    TerminalProgram(std::vector<std::string> arguments, int columns, const std::vector<std::string>& environment);
    ~TerminalProgram();
    TerminalProgram(const TerminalProgram&) = delete;
    TerminalProgram& operator=(const TerminalProgram&) = delete;

    void resize(int columns);
    /// Gives what the program writes to `take`, until it ends; returns its exit code, -1 if it was killed or says
    /// nothing for a minute.
    int follow(const std::function<void(const std::string&)>& take);

  private:
    pid_t pid_ = 0;
    int terminal_ = -1;
};

}  // namespace treefarm::test
