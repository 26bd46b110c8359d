// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/base/console.h"
#include "coordinator/words/time_left.h"

namespace treefarm {

/// How far a render is, in the words of its budget. What is not known is empty.
struct RenderWords {
    double fraction = -1;     ///< negative: not known
    std::string how_far;      ///< "54 % of 127 spp", "54 % of 60 s", "error 12 %, wanted 5 %"
    std::string left;         ///< "about 6 s left"
    std::string pass;         ///< "pass 6/7"
    std::string since_begin;  ///< "7.1 s"
    std::string error;        ///< "error 42.8 %"
    double run_seconds = 0;
};
RenderWords render_words(const RenderProgress& progress, const Job::Budget& budget, const TimeLeft& left);

/// Words before the first worker asks for work: scene and tree are on their way, or being prepared.
RenderWords preparing_words(double seconds);

/// A render that stands for itself. What is rendered as a part of something more frames its words otherwise.
Status render_status(const RenderWords& words);
using StatusFrame = std::function<Status(const RenderWords&)>;

/// Shows on a console how far a render is, until it is destroyed.
class Progress {
  public:
    Progress(ConsolePtr console, const Job::Budget& budget, StatusFrame frame);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(const RenderProgress& progress);
    void clear() { console_->end_status(); }

  private:
    const ConsolePtr console_;
    const Job::Budget budget_;
    const StatusFrame frame_;
    TimeLeftClock left_;
    const Timer clock_;
};

}  // namespace treefarm
