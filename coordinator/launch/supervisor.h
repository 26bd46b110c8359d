// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "coordinator/launch/restart_count.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

/// Time limits of a supervisor, seconds.
struct SupervisorLimits {
    double start = 60;          ///< until the first heartbeat
    double beat = 30;           ///< between two heartbeats
    double stall = 300;         ///< without progress; or stall_multiple times the longest so far in this phase,
    double stall_multiple = 5;  ///< whichever is longer
    /// from the last heartbeat of a coordinator that knows its exit code to its launcher's end
    double leave = 15;
    double leave_all = 600;   ///< from that code to the launcher's end, with or without heartbeats
    double stop = 30;         ///< without progress, after it was told to stop
    double terminate = 3;     ///< between SIGTERM and SIGKILL
    double disk = 5;          ///< between an attempt that the disk refused and the next one
    double disk_all = 43200;  ///< for which the disk takes no files
    int restarts = 5;         ///< in a row without progress
    int attempts = 100;       ///< in total
};

/// Observations of a supervisor at one moment.
struct Sight {
    double now = 0;                    ///< seconds of its own clock
    bool running = false;              ///< the started process exists
    std::string not_started;           ///< reason why the attempt could not be started
    std::string disk;                  ///< reason why files cannot be written now, between two attempts; "": they can
    bool readable = true;              ///< the heartbeat file could be looked for
    bool coordinator_gone = false;     ///< its process existed and has ended
    std::optional<LifeStatus> status;  ///< content of the heartbeat file, of this attempt or another
    std::optional<int> summary;        ///< exit code in the attempt's summary.json
    std::uint64_t checkpoint = 0;      ///< newest generation on disk
};

/// Actions of a supervisor, as functions. Each may throw InputError, which leaves Supervisor::step().
struct SupervisorActions {
    std::function<void(int)> start;               ///< an attempt, by its number
    std::function<void()> ask_to_stop;            ///< SIGUSR1: write, and leave
    std::function<void(const LifeStatus&)> dump;  ///< SIGABRT to a coordinator without progress
    std::function<void()> terminate;              ///< SIGTERM
    std::function<void()> kill;                   ///< SIGKILL to all processes of the attempt
    std::function<void(const std::string&)> say;
};

/// Result of a supervised render.
struct SupervisorEnd {
    int code = 1;
    std::string words;  ///< reason, unless the render itself set the exit code; "" otherwise
    bool resumable = false;
};

/// Supervisor of a render: starts attempts, watches their heartbeats, ends those without progress, and starts the next
/// one. Independent of processes, files and clocks: it receives observations and calls actions.
class Supervisor {
  public:
    /// `name`: name of an attempt by its number.
    Supervisor(SupervisorLimits limits, SupervisorActions actions, std::function<std::string(int)> name);

    /// Records a request to stop, by a user or a batch system: the first one stops in order, the second at once.
    void ask_to_stop();

    /// Advances the supervisor; to be called often, at least while something changes. Returns the result, once there is
    /// one.
    std::optional<SupervisorEnd> step(const Sight& sight);

    int attempt() const { return attempt_; }

  private:
    enum class State { waiting, running, stopping, terminating, killed };

    void forgive_gap(double now);
    void start(double now);
    std::optional<SupervisorEnd> start_when_due(const Sight& sight);
    void look(const Sight& sight);
    void watch(const Sight& sight);
    void watch_stop(const Sight& sight);
    void end_attempt(double now, const std::string& why);
    void push_stop(double now);
    std::optional<int> code(const Sight& sight) const;
    std::optional<SupervisorEnd> gone(const Sight& sight);
    std::optional<SupervisorEnd> restart_or_end(const Sight& sight, const std::string& why, const std::string& stage);
    double stall_limit() const;

    const SupervisorLimits limits_;
    const SupervisorActions actions_;
    const std::function<std::string(int)> name_;
    RestartCount restarts_;
    State state_ = State::waiting;
    int attempt_ = 0;
    int stops_ = 0, heeded_stops_ = 0;  ///< stop requests received, and acted upon
    double last_step_ = 0, due_ = 0;
    double began_ = 0, beat_at_ = 0, progress_at_ = 0, phase_at_ = 0, acted_at_ = 0;
    std::optional<double> code_at_;                 ///< time since when the exit code is known
    std::optional<LifeStatus> own_;                 ///< last heartbeat of this attempt
    std::array<double, kLifePhases> longest_ = {};  ///< per phase: longest time without progress so far
    bool told_unreadable_ = false;
    std::string told_disk_;    ///< Sight::disk as it was last reported
    std::string why_, stage_;  ///< reason for ending the attempt, and where it was then
};

/// Phase of an attempt in words: "pass 3", "reading the input".
std::string life_stage(const std::optional<LifeStatus>& status);

}  // namespace treefarm
