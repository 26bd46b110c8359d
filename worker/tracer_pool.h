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
    /// Ends the threads after their present units. Threads that are still tracing after ten seconds are left
    /// behind: a process must end even if one is stuck.
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
    std::uint64_t samples() const { return state_->samples; }
    std::uint64_t rays() const { return state_->rays; }

  private:
    /// State shared with the threads, which may outlive the pool.
    struct State {
        RenderUnit render;
        mutable std::mutex mutex;
        std::condition_variable changed;
        std::shared_ptr<PassWork> pass;
        std::deque<WorkUnit> queue;
        unsigned running = 0;
        bool stop = false;
        std::optional<std::string> failure;
        std::atomic<std::uint64_t> samples{0}, rays{0};
    };
    static void run(State& state);
    static void trace(State& state, PassWork& pass, const WorkUnit& unit, UnitOutput& output);
    void stop();

    const std::shared_ptr<State> state_ = std::make_shared<State>();
    std::vector<std::thread> threads_;
};

}  // namespace treefarm
