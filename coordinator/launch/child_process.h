// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace treefarm {

/// A program in a session and process group of its own, which gets SIGTERM where this process dies before it. What it
/// says on its standard error can be read.
class ChildProcess {
  public:
    enum class Heard { errors, all };  ///< its standard error, or its standard output with it
    /// `variable`: "NAME=value", added to its environment. `input`: a file to read from; empty: none. Throws RunError
    /// where it cannot be started; a program that is not there ends with code 127.
    ChildProcess(const std::vector<std::string>& words, const std::string& variable, Heard heard = Heard::errors,
                 const std::string& input = "");
    /// Kills it.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    bool running();
    void signal(int number);
    /// To the whole group.
    void signal_group(int number);
    pid_t pid() const { return pid_; }
    bool succeeded() const;  ///< ended with code 0
    /// How it ended: "exit code 1", "signal 9".
    std::string ending() const;

    /// End of the pipe of what it says; does not block.
    int words_descriptor() const { return words_; }
    /// What it has said since the last call.
    std::string take_words();

  private:
    pid_t pid_ = 0;
    int words_ = -1;
    bool ended_ = false;
    int status_ = 0;
};

}  // namespace treefarm
