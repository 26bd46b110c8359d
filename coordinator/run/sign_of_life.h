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

/// An attempt of `treefarm launch`, as a process that it started knows it.
struct LifeAttempt {
    std::string name;            ///< "3f19c2.4": of the launch, and its number
    std::filesystem::path file;  ///< where signs of life go
};

/// Variable of the environment that names the attempt to a process.
inline constexpr const char* kAttemptVariable = "TREEFARM_ATTEMPT";

/// Text for it, and back; a text that is none gives an attempt without a name.
std::string attempt_text(const LifeAttempt& attempt);
LifeAttempt parse_attempt(const std::string& text);

/// Writes a coordinator's sign of life once a second, from a thread of its own, which touches nothing that is rendered
/// with. A file that cannot be written is written at the next second.
class SignOfLife {
  public:
    explicit SignOfLife(LifeAttempt attempt) : attempt_(std::move(attempt)) {}
    ~SignOfLife();
    SignOfLife(const SignOfLife&) = delete;
    SignOfLife& operator=(const SignOfLife&) = delete;

    const std::string& attempt() const { return attempt_.name; }

    /// Begins: the process has come so far as to speak.
    void begin();
    void enter(LifePhase phase);
    /// What the main loop sees; `work` is any figure that changes while workers get on. Called as often as one likes.
    struct Pass {
        std::uint32_t pass = 0;
        std::uint64_t passes = 0;
        std::uint64_t work = 0;
    };
    void see(const Pass& pass);
    /// Calls `list` where the workers were not listed within the last second.
    void see_workers(const std::function<std::vector<LifeWorker>()>& list);
    /// A render of a series is done.
    void finish_render();
    /// The exit code is known: written before this returns, if it can be. `by_launcher`: it is that of an interruption
    /// by mpirun.
    void end(int code, bool by_launcher = false);

  private:
    void work();
    void write();

    const LifeAttempt attempt_;
    std::mutex file_;   ///< one writes at a time
    std::mutex mutex_;  ///< of what follows; taken after file_
    std::condition_variable changed_;
    LifeStatus status_;
    std::uint64_t told_ = 0;       ///< progress that the main loop told
    std::uint64_t last_work_ = 0;  ///< the figure that it told last
    std::uint64_t effort_ = 0;     ///< progress by what the process takes, where the main loop does not speak
    std::uint64_t listed_ = 0;     ///< beat of the last list of workers
    bool has_list_ = false;
    bool stopping_ = false;
    std::thread thread_;  ///< last: it uses the others
};

}  // namespace treefarm
