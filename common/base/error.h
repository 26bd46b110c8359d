// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace treefarm {

/// Position in an input file. `line` and `column` count from 1; 0: unknown.
struct Location {
    std::string file;
    int line = 0;
    int column = 0;

    /// Text "file:line:col" without the unknown parts.
    std::string text() const;
    bool operator==(const Location&) const = default;
};

/// Bad usage or bad input: the program ends with exit code 2. The message is one line, "file:line:col: what, why, what
/// to do": an editor can jump to the position, and a person knows the next step.
class InputError : public std::runtime_error {
  public:
    InputError(const Location& where, const std::string& what, const std::string& cure);
    explicit InputError(const std::string& message) : std::runtime_error(message), problem_(message) {}

    /// The parts of the message.
    const Location& where() const { return where_; }
    const std::string& problem() const { return problem_; }
    const std::string& cure() const { return cure_; }

  private:
    Location where_;
    std::string problem_, cure_;
};

/// Failure of the run itself (lost workers, full disk, an internal inconsistency): exit code 1.
class RunError : public std::runtime_error {
  public:
    explicit RunError(const std::string& message) : std::runtime_error(message) {}
};

/// Malformed bytes from another process or from a file.
class FormatError : public RunError {
  public:
    explicit FormatError(const std::string& message) : RunError(message) {}
};

}  // namespace treefarm
