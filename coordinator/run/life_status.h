// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace treefarm {

/// Folder in a run directory that `treefarm launch` writes to.
inline constexpr const char* kLaunchFolder = "launch";

/// What a coordinator is about.
enum class LifePhase : std::uint8_t {
    start,    ///< nothing was read yet
    scene,    ///< the input is being read
    gather,   ///< workers are waited for
    pass,     ///< workers trace
    combine,  ///< passes become an image, and the next tree
    write,    ///< the last files are written
    end,      ///< the exit code is known
};
inline constexpr int kLifePhases = 7;
const char* life_phase_name(LifePhase phase);

/// A worker as the coordinator sees it.
struct LifeWorker {
    std::string host;
    bool lost = false;  ///< was silent, or said what was wrong
    bool operator==(const LifeWorker&) const = default;
};

/// A coordinator's sign of life, as a file says it: counters, which a reader holds against its own clock, since two
/// machines need not have one time.
struct LifeStatus {
    std::string attempt;         ///< whose it is
    std::uint64_t beat = 0;      ///< counts up while the process lives
    std::uint64_t progress = 0;  ///< counts up while its work gets on
    LifePhase phase = LifePhase::start;
    std::uint32_t pass = 0;     ///< that is open
    std::uint64_t passes = 0;   ///< that are finished, in all lives of the render
    std::uint64_t renders = 0;  ///< that this attempt has finished, of a series
    std::string host;
    int pid = 0;
    std::vector<LifeWorker> workers;
    std::optional<int> code;  ///< exit code, once it is known
    /// Whether its launcher interrupted it, of which nobody had asked that.
    bool ended_by_launcher = false;
};

/// JSON; what is no UTF-8 is replaced.
std::string life_status_text(const LifeStatus& status);
/// Nothing for what is no status.
std::optional<LifeStatus> parse_life_status(const std::string& text);

}  // namespace treefarm
