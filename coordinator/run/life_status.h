// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace treefarm {

/// Phase of a coordinator's work.
enum class LifePhase : std::uint8_t {
    start,    ///< nothing has been read yet
    scene,    ///< the input is being read
    gather,   ///< waiting for workers
    pass,     ///< workers trace
    combine,  ///< passes are combined into an image, and the next tree is built
    write,    ///< the last files are written
    end,      ///< the exit code is known
};
inline constexpr int kLifePhases = 7;
const char* life_phase_name(LifePhase phase);

/// A worker as the coordinator reports it.
struct LifeWorker {
    std::string host;
    bool lost = false;  ///< was silent, or sent an invalid message
    bool operator==(const LifeWorker&) const = default;
};

/// A coordinator's heartbeat file: counters, which a reader compares by its own clock, since two machines' clocks may
/// differ.
struct LifeStatus {
    std::string attempt;         ///< attempt that wrote it
    std::uint64_t beat = 0;      ///< increases while the process lives
    std::uint64_t progress = 0;  ///< increases while its work makes progress
    LifePhase phase = LifePhase::start;
    std::uint32_t pass = 0;     ///< present pass
    std::uint64_t passes = 0;   ///< finished passes, including those before a resume
    std::uint64_t renders = 0;  ///< finished renders of this attempt, in a series
    std::string host;
    int pid = 0;
    std::vector<LifeWorker> workers;
    std::optional<int> code;  ///< exit code, once known
    /// Whether its launcher interrupted it, without a request from the user.
    bool ended_by_launcher = false;
};

/// JSON text; invalid UTF-8 is replaced.
std::string life_status_text(const LifeStatus& status);
/// Status from a JSON text; no value for other texts.
std::optional<LifeStatus> parse_life_status(const std::string& text);

/// First character of a line that holds a status in a coordinator's error output: "record separator". No other line
/// has it, since messages are printable.
inline constexpr char kLifeMark = '\x1e';
/// Line with a status, for the time in which its file cannot be written. Without the workers if a pipe might not take
/// the line as a whole (PIPE_BUF).
std::string life_line(LifeStatus status);

}  // namespace treefarm
