// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "coordinator/farm/ledger.h"

namespace treefarm {

/// Speed of a worker, from its accepted results alone: a worker may claim any progress. Times are seconds of any clock.
class WorkerSpeed {
  public:
    /// The worker has units from now on, if it had none before.
    void begin(double now);
    /// A result with `paths` paths was accepted; `busy`: the worker has further units. With 0 paths, the pass ended
    /// before it delivered.
    void deliver(double now, std::uint64_t paths, bool busy);

    /// Paths per second, an exponential mean with a half-life of two seconds over the time with units; no value before
    /// the first result.
    std::optional<double> paths_per_second() const { return speed_; }
    /// Seconds since the last result, or since the first unit; 0 without units.
    double waited(double now) const { return since_ ? now - *since_ : 0.0; }

  private:
    std::optional<double> since_;
    std::optional<double> speed_;
};

/// Threads and speed of a present worker.
struct WorkerRate {
    unsigned threads = 1;
    std::optional<double> speed;  ///< paths per second
    /// Upper bound of the speed, paths per second: otherwise it would have delivered something by now.
    double most = std::numeric_limits<double>::infinity();
};

/// Rate of a worker with `outstanding` paths that sends results every `result_seconds`. Overdue paths bound its speed,
/// so that a longer wait makes copies of its units worthwhile, whatever it claims.
WorkerRate worker_rate(const WorkerSpeed& speed, unsigned threads, std::uint64_t outstanding, double result_seconds,
                       double now);

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
    /// Whether a worker should have delivered all its units long ago, as if threads of it were stuck.
    bool is_overdue(int worker) const;

  private:
    double speed(int worker) const;
    double speed_when_it_delivers(int worker) const;

    std::map<int, WorkerRate> rates_;
    double per_thread_ = 0;  ///< mean speed of a thread, paths per second; 0: unknown
    double fastest_ = 0;     ///< greatest known speed, paths per second: a limit for unknown ones
    double total_ = 0;
};

}  // namespace treefarm
