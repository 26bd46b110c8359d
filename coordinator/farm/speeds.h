// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "coordinator/farm/ledger.h"

namespace treefarm {

/// Speed of a worker, from the samples that its heartbeats report, delivered or not.
class WorkerSpeed {
  public:
    /// Adds a heartbeat at `now`, in seconds of any clock: `samples` traced since the start; `busy`: the worker had
    /// units. Only intervals between two busy heartbeats count.
    void beat(double now, std::uint64_t samples, bool busy);

    /// Paths per second, an exponential mean with a half-life of two seconds; no value before two heartbeats with
    /// units.
    std::optional<double> paths_per_second() const { return speed_; }

  private:
    struct Beat {
        double at = 0;
        std::uint64_t samples = 0;
    };
    std::optional<Beat> last_;  ///< last heartbeat with units
    std::optional<double> speed_;
};

/// Threads and speed of a present worker.
struct WorkerRate {
    unsigned threads = 1;
    std::optional<double> speed;  ///< paths per second
};

/// Speeds of all workers, by peer; one of unknown speed counts with the mean speed per thread of the others.
class Speeds {
  public:
    explicit Speeds(const std::map<int, WorkerRate>& rates);

    /// Limits of the units for a worker that requests `credit` units and has `queued` paths to begin, with `waiting`
    /// paths in all: two seconds of work at most, and a quarter of its part of the rest, so that pieces shrink for slow
    /// workers and towards the end. At least one path if nothing is queued.
    Portion portion(int worker, std::size_t credit, std::uint64_t queued, std::uint64_t waiting) const;

    /// Seconds saved by a copy of a unit of `paths` paths at worker `here`, if its holder has `outstanding` paths to
    /// go; 0 if none, or too few to outweigh the loss if both end at the same time.
    double gain(int here, std::uint64_t paths, int holder, std::uint64_t outstanding) const;

  private:
    double speed(int worker) const;

    std::map<int, WorkerRate> rates_;
    double per_thread_ = 0;  ///< mean speed of a thread, paths per second; 0: unknown
    double total_ = 0;
};

}  // namespace treefarm
