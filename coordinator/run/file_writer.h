// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/base/timer.h"

namespace treefarm {

/// Rate limit of a file: the next write begins at least `least` seconds after the last one, and at least `multiple`
/// times its duration.
struct Pace {
    double least = 0;
    double multiple = 0;
};

/// Writer of files in a thread of its own, so that no other thread waits for a disk. Only the newest version of each
/// file waits. A failed write is retried each second.
class FileWriter {
  public:
    using Write = std::function<void()>;  ///< makes the content and writes it; throws on failure

    FileWriter() : thread_([this] { work(); }) {}
    ~FileWriter() { stop(); }
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    /// Replaces the version waiting under this name. The writer's thread calls `write`, possibly several times.
    void put(const std::string& name, Write write, Pace pace = {});

    /// Drops the version waiting under this name, or waits until it is written if that has begun.
    void forget(const std::string& name);

    /// News since the last call: each kind of error (an errno) once, and the end of all errors.
    std::vector<std::string> take_news();

    /// Completes the present write and drops those that wait. Returns the names that were put and not written since.
    std::vector<std::string> stop();

  private:
    struct Slot {
        Write write;  ///< empty: none waits
        Pace pace;
        double due = 0;  ///< earliest time
        bool failed = false;
    };
    using Slots = std::map<std::string, Slot>;

    void work();
    Slots::iterator next_due();
    void run(Slots::iterator slot, std::unique_lock<std::mutex>& lock);
    void tell_failure(int kind, const std::string& message);
    void tell_recovery();

    std::mutex mutex_;
    std::condition_variable changed_, idle_;
    const Timer clock_;
    Slots slots_;
    std::set<int> reported_;  ///< kinds of errors
    bool trouble_ = false;    ///< reported, and not over
    std::vector<std::string> news_;
    bool stopping_ = false;
    std::string writing_;  ///< name of the file in progress; empty: none
    std::thread thread_;   ///< last: it uses the others
};

}  // namespace treefarm
