// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "coordinator/launch/life_status.h"
#include "coordinator/launch/restart_count.h"

namespace treefarm {

/// Limits of a supervisor's patience, seconds.
struct SupervisorLimits {
    double start = 60;          ///< until the first sign of life
    double beat = 30;           ///< between two beats
    double stall = 300;         ///< without progress, or so many times what the phase took before:
    double stall_multiple = 5;  ///< whichever is longer
    double leave = 15;       ///< between the last beat of a coordinator that knows its exit code and its launcher's end
    double leave_all = 600;  ///< between that code and the launcher's end, whatever still beats
    double stop = 30;        ///< without progress, once it was told to stop
    double terminate = 3;    ///< between SIGTERM and SIGKILL
    int restarts = 5;        ///< in a row that bring nothing
    int attempts = 100;      ///< in all
};

/// What a supervisor sees at one moment.
struct Sight {
    double now = 0;                    ///< seconds of its own clock
    bool running = false;              ///< the process that it started is there
    std::string not_started;           ///< why the attempt could not be started at all
    bool readable = true;              ///< the sign of life could be looked for
    bool coordinator_gone = false;     ///< its process was here, and is not any more
    std::optional<LifeStatus> status;  ///< what is there, of this attempt or another
    std::optional<int> summary;        ///< exit code by the attempt's summary.json
    std::uint64_t checkpoint = 0;      ///< generation of the newest on disk
};

/// What a supervisor has done. Each may throw InputError, which leaves Supervisor::step().
struct SupervisorActions {
    std::function<void(int)> start;               ///< an attempt, by its number
    std::function<void()> ask_to_stop;            ///< SIGUSR1: write, and leave
    std::function<void(const LifeStatus&)> dump;  ///< SIGABRT to a coordinator that stands still
    std::function<void()> terminate;              ///< SIGTERM
    std::function<void()> kill;                   ///< SIGKILL to all that the attempt has started
    std::function<void(const std::string&)> say;
};

/// How it all ended.
struct SupervisorEnd {
    int code = 1;
    std::string words;  ///< why, where it is no exit code of the render's own; "" otherwise
    bool resumable = false;
};

/// Keeps a render alive: starts attempts, watches their signs of life, ends those that stand still, and starts the next
/// one. Knows no process, file or clock: it is told what is there, and says what is to be done.
class Supervisor {
  public:
    /// `name` gives an attempt's name by its number.
    Supervisor(SupervisorLimits limits, SupervisorActions actions, std::function<std::string(int)> name);

    /// A person or a batch system wants an end: first in order, then at once.
    void ask_to_stop();

    /// To be called often, at least while something changes. Returns how it ended, once it has.
    std::optional<SupervisorEnd> step(const Sight& sight);

    int attempt() const { return attempt_; }

  private:
    enum class State { waiting, running, stopping, terminating, killed };

    void forgive_gap(double now);
    void start(double now);
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
    int stops_ = 0, heeded_stops_ = 0;  ///< asked for, and acted upon
    double last_step_ = 0, due_ = 0;
    double began_ = 0, beat_at_ = 0, progress_at_ = 0, phase_at_ = 0, acted_at_ = 0;
    std::optional<double> code_at_;                 ///< the exit code has been known since
    std::optional<LifeStatus> own_;                 ///< last sign of life of this attempt
    std::array<double, kLifePhases> longest_ = {};  ///< that each phase was without progress so far
    bool told_unreadable_ = false;
    std::string why_, stage_;  ///< why the attempt is ended by us, and where it was then
};

/// Words of an attempt's place: "pass 3", "reading the input".
std::string life_stage(const std::optional<LifeStatus>& status);

}  // namespace treefarm
