// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "common/base/status.h"
#include "common/base/terminal.h"
#include "common/base/timer.h"

namespace treefarm {

/// How much of a log a person sees.
enum class Verbosity {
    quiet,    ///< errors
    normal,   ///< what a stranger wants to know
    verbose,  ///< every figure
};

/// Output for a person: lines of text and, on a terminal, below them a line that is drawn again and again. Where
/// nothing can be drawn again the status is a whole line every ten seconds. Threads may share it.
class Console {
  public:
    /// Writes to `descriptor`. `shows_status`: otherwise only lines.
    Console(TerminalKind kind, bool shows_status, int descriptor = 2);
    ~Console() { end_status(); }
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// A line with its end; the status stays below it.
    void line(const std::string& text);
    /// How far things are. Called as often as one likes.
    void status(const Status& status);
    /// Wipes the status.
    void end_status();
    const TerminalKind& kind() const { return kind_; }

  private:
    void write(const std::string& text) const;
    std::string drawn_status() const;

    const TerminalKind kind_;
    const bool shows_status_;
    const int descriptor_;
    const Timer clock_;
    std::mutex mutex_;
    StatusPace pace_;
    Status status_;
    bool drawn_ = false;
};

using ConsolePtr = std::shared_ptr<Console>;

}  // namespace treefarm
