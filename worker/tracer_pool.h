// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "worker/integrators/contract.h"
#include "worker/pass_work.h"

namespace treefarm {

/// Pool of tracing threads, fed by the communication thread: each takes a unit, renders it, and delivers it to its
/// pass.
class TracerPool {
  public:
    TracerPool(unsigned threads, RenderUnit render);
    ~TracerPool();

    /// Begins a pass, to which later units belong. Queued units are dropped; those being traced are delivered to their
    /// own pass.
    void begin(std::shared_ptr<PassWork> pass);
    void add(std::span<const WorkUnit> units);
    /// Drops all queued units.
    void cancel();
    /// Drops these units if they are queued.
    void drop(std::span<const WorkUnit> units);

    std::size_t queued() const;
    /// Sum of the queued units' weights (work_unit.h).
    std::uint64_t queued_weight() const;
    /// Whether no unit is queued or being traced.
    bool idle() const;
    /// Error message of a failed thread, if any.
    std::optional<std::string> failure() const;

    unsigned thread_count() const { return static_cast<unsigned>(threads_.size()); }
    /// Samples and rays traced since the start.
    std::uint64_t samples() const { return samples_; }
    std::uint64_t rays() const { return rays_; }

  private:
    void run();
    void stop();
    void trace(PassWork& pass, const WorkUnit& unit, UnitOutput& output);

    RenderUnit render_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::shared_ptr<PassWork> pass_;
    std::deque<WorkUnit> queue_;
    unsigned running_ = 0;
    bool stop_ = false;
    std::optional<std::string> failure_;
    std::atomic<std::uint64_t> samples_{0}, rays_{0};
    std::vector<std::thread> threads_;
};

}  // namespace treefarm
