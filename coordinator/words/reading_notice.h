// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "common/base/console.h"

namespace treefarm {

/// Notice that a file is being read, with the seconds so far; shown while the object lives, from one second on at a
/// terminal, ten seconds elsewhere.
class ReadingNotice {
  public:
    ReadingNotice(ConsolePtr console, std::string name);
    ~ReadingNotice();
    ReadingNotice(const ReadingNotice&) = delete;
    ReadingNotice& operator=(const ReadingNotice&) = delete;

  private:
    void run();

    const ConsolePtr console_;
    const std::string name_;
    std::mutex mutex_;
    std::condition_variable over_;
    bool done_ = false;
    std::thread thread_;
};

/// Status line "reading kitchen   3 s so far".
Status reading_status(const std::string& name, double seconds);

}  // namespace treefarm
