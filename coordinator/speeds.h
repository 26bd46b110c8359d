// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "coordinator/ledger.h"

namespace treefarm {

/// Speed of a worker by its heartbeats, which say what it has traced so far, delivered or not.
class WorkerSpeed {
  public:
    /// Takes in a heartbeat at `now`, seconds of any clock: `samples` traced since the start, and whether the worker
    /// had work. Only what lies between two with work counts.
    void beat(double now, std::uint64_t samples, bool busy);

    /// Paths per second, an exponential mean with a half-life of two seconds; nothing before two heartbeats with work.
    std::optional<double> paths_per_second() const { return speed_; }

  private:
    struct Beat {
        double at = 0;
        std::uint64_t samples = 0;
    };
    std::optional<Beat> last_;  ///< with work
    std::optional<double> speed_;
};

/// A worker that work may be handed to.
struct WorkerRate {
    unsigned threads = 1;
    std::optional<double> speed;  ///< paths per second
};

/// Speeds of workers beside each other, by peer; one without a speed is taken for as fast as others by its threads.
class Speeds {
  public:
    explicit Speeds(const std::map<int, WorkerRate>& rates);

    /// How much a worker gets that asks with `credit` and has `queued` paths to begin, while so many wait: for two
    /// seconds at most, and a quarter of its part of what is left, so that pieces shrink by themselves for the slow and
    /// towards the end. With nothing queued it gets something.
    Portion portion(int worker, std::size_t credit, std::uint64_t queued, std::uint64_t waiting) const;

    /// Seconds that a copy of a unit of `paths` here saves, whose holder has `outstanding` paths to go; 0: none, or not
    /// enough for what may be lost where both end together.
    double gain(int here, std::uint64_t paths, int holder, std::uint64_t outstanding) const;

  private:
    double speed(int worker) const;

    std::map<int, WorkerRate> rates_;
    double per_thread_ = 0;  ///< paths per second of a thread, of those known; 0: none is
    double total_ = 0;
};

}  // namespace treefarm
