// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "common/base/status.h"
#include "common/base/terminal.h"
#include "common/base/timer.h"

namespace treefarm {

/// Amount of log output on the console; the log file gets everything.
enum class Verbosity {
    quiet,    ///< errors only
    normal,   ///< results, decisions and warnings
    verbose,  ///< every figure
};

/// Output for a person: lines of text and, on a terminal, a status line below them that is redrawn. Where nothing can
/// be redrawn (a file, a pipe) the status becomes a whole line every ten seconds. Thread-safe.
class Console {
  public:
    /// `descriptor`: file descriptor of the output. `shows_status`: false suppresses the status, not the lines.
    Console(TerminalKind kind, bool shows_status, int descriptor = 2);
    ~Console() { end_status(); }
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// Writes a line and its line end; the status stays below it.
    void line(const std::string& text);
    /// Updates the progress shown. Cheap: redrawing is limited, so it may be called at any rate.
    void status(const Status& status);
    /// Erases the status line.
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
