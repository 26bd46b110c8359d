// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace treefarm {

/// A child process in a session and process group of its own; it gets SIGTERM if this process dies first. Its standard
/// error can be read.
class ChildProcess {
  public:
    enum class Heard { errors, all };  ///< standard error alone, or with standard output
    /// `variables`: "NAME=value", added to its environment. `input`: a file for its standard input; empty: none. Throws
    /// RunError if it cannot be started; a missing program ends with code 127.
    explicit ChildProcess(const std::vector<std::string>& words, const std::vector<std::string>& variables = {},
                          Heard heard = Heard::errors, const std::string& input = "");
    /// Kills the process.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    bool running();
    void signal(int number);
    /// Sends a signal to the whole group.
    void signal_group(int number);
    pid_t pid() const { return pid_; }
    bool succeeded() const;  ///< ended with code 0
    /// Way in which it ended: "exit code 1", "signal 9".
    std::string ending() const;

    /// Read end of its output pipe; does not block.
    int words_descriptor() const { return words_; }
    /// Output since the last call.
    std::string take_words();

  private:
    pid_t pid_ = 0;
    int words_ = -1;
    bool ended_ = false;
    int status_ = 0;
};

}  // namespace treefarm
