// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/run/life_status.h"

namespace treefarm {

/// An attempt of `treefarm launch`, as seen by a process that it started.
struct LifeAttempt {
    std::string name;            ///< "3f19c2.4": id of the launch, number of the attempt
    std::filesystem::path file;  ///< heartbeat file
};

/// Environment variable that passes the attempt to a process.
inline constexpr const char* kAttemptVariable = "TREEFARM_ATTEMPT";

/// Text of an attempt and its inverse; other texts give an attempt without a name.
std::string attempt_text(const LifeAttempt& attempt);
LifeAttempt parse_attempt(const std::string& text);

/// Writer of a coordinator's heartbeat file, once a second in a thread of its own, which shares nothing with rendering.
/// While the file cannot be written, the heartbeats are lines of the error output instead: a full disk is no silence.
class SignOfLife {
  public:
    explicit SignOfLife(LifeAttempt attempt) : attempt_(std::move(attempt)) {}
    ~SignOfLife();
    SignOfLife(const SignOfLife&) = delete;
    SignOfLife& operator=(const SignOfLife&) = delete;

    const std::string& attempt() const { return attempt_.name; }

    /// Begins the heartbeats, once the process can report.
    void begin();
    void enter(LifePhase phase);
    /// Progress as seen by the main loop; `work` is any figure that changes while workers make progress. May be set at
    /// any rate.
    struct Pass {
        std::uint32_t pass = 0;
        std::uint64_t passes = 0;
        std::uint64_t work = 0;
    };
    void see(const Pass& pass);
    /// Calls `list` if the workers were not listed within the last second.
    void see_workers(const std::function<std::vector<LifeWorker>()>& list);
    /// Counts a finished render of a series.
    void finish_render();
    /// Sets the exit code, and writes it before returning, if possible. `by_launcher`: mpirun caused the interruption.
    void end(int code, bool by_launcher = false);

  private:
    void work();
    void write();

    const LifeAttempt attempt_;
    std::mutex file_;   ///< serialises writes
    std::mutex mutex_;  ///< guards the members below; locked after file_
    std::condition_variable changed_;
    LifeStatus status_;
    std::uint64_t told_ = 0;       ///< progress reported by the main loop
    std::uint64_t last_work_ = 0;  ///< last `work` value that it reported
    std::uint64_t effort_ = 0;     ///< progress by processor and disk use, while the main loop is silent
    std::uint64_t listed_ = 0;     ///< beat at the last list of workers
    bool has_list_ = false;
    bool stopping_ = false;
    std::thread thread_;  ///< last: it uses the others
};

}  // namespace treefarm
