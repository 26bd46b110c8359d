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

/// How often a file may be written: the next time not before `least` seconds after the last, nor before `multiple`
/// times the seconds that the last took.
struct Pace {
    double least = 0;
    double multiple = 0;
};

/// Writes files beside the render, in a thread of its own: nobody waits for a disk. Of each file only the newest
/// version is kept until it is written. What fails is tried again each second.
class FileWriter {
  public:
    using Write = std::function<void()>;  ///< makes the content and writes it; throws what went wrong

    FileWriter() : thread_([this] { work(); }) {}
    ~FileWriter() { stop(); }
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    /// Puts `write` in the place of what waits under this name. The writer's thread calls it, possibly several times.
    void put(const std::string& name, Write write, Pace pace = {});

    /// Drops what waits under this name, or waits for it where it is being written.
    void forget(const std::string& name);

    /// News since the last call: each kind of trouble (an errno) once, and that all is written again.
    std::vector<std::string> take_news();

    /// Ends what is being written; what waits is forgotten. Returns the names that were put and not written since.
    std::vector<std::string> stop();

  private:
    struct Slot {
        Write write;  ///< empty: nothing waits
        Pace pace;
        double due = 0;  ///< not before
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
    std::set<int> reported_;  ///< kinds of trouble
    bool trouble_ = false;    ///< told, and not over
    std::vector<std::string> news_;
    bool stopping_ = false;
    std::string writing_;  ///< the name; empty: none
    std::thread thread_;   ///< last: it uses the others
};

}  // namespace treefarm
