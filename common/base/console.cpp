// SPDX-License-Identifier: Apache-2.0
#include "common/base/console.h"

#include <unistd.h>

#include <cerrno>

#include "common/base/text/printable.h"

namespace treefarm {

namespace {

constexpr double kRedrawSeconds = 0.2;
constexpr double kLineSeconds = 10;
constexpr const char* kWipe = "\r\x1b[K";

}  // namespace

Console::Console(TerminalKind kind, bool shows_status, int descriptor)
    : kind_(kind),
      shows_status_(shows_status),
      descriptor_(descriptor),
      pace_(kind.live ? StatusPace(0, kRedrawSeconds) : StatusPace(kLineSeconds, kLineSeconds)) {}

/// Writes a text in one system call where possible, since several processes of mpirun share a terminal. Write errors
/// are ignored: a render must not end because its terminal is closed.
void Console::write(const std::string& text) const {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) done += static_cast<std::size_t>(count);
    }
}

/// The status line in its current form. The width is asked for each time, since a window may be resized. The last
/// column stays free: some terminals begin a new line once it is filled.
std::string Console::drawn_status() const {
    return "\r" + status_text(status_, terminal_columns(descriptor_) - 1) + "\x1b[K";
}

void Console::line(const std::string& text) {
    const std::lock_guard lock(mutex_);
    write((drawn_ ? kWipe : "") + text + "\n" + (drawn_ ? drawn_status() : ""));
}

void Console::status(const Status& status) {
    if (!shows_status_) return;
    const std::lock_guard lock(mutex_);
    if (!pace_.due(clock_.seconds())) return;
    if (!kind_.live) {
        write(printable(status.line) + "\n");
        return;
    }
    status_ = status;
    drawn_ = true;
    write(drawn_status());
}

void Console::end_status() {
    const std::lock_guard lock(mutex_);
    if (drawn_) write(kWipe);
    drawn_ = false;
}

}  // namespace treefarm
