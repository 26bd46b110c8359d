// SPDX-License-Identifier: Apache-2.0
#include "worker/tracer_pool.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "common/base/timer.h"

namespace treefarm {

TracerPool::TracerPool(unsigned threads, RenderUnit render) {
    state_->render = std::move(render);
    try {
        for (unsigned t = 0; t < threads; ++t)
            threads_.emplace_back([state = state_] { run(*state); });
    } catch (...) {  // thread creation failed: threads already running must not outlive the pool
        stop();
        throw;
    }
}

TracerPool::~TracerPool() {
    stop();
}

void TracerPool::stop() {
    constexpr std::chrono::seconds kPatience{10};
    bool ended = false;
    {
        std::unique_lock lock(state_->mutex);
        state_->stop = true;
        state_->changed.notify_all();
        ended = state_->changed.wait_for(lock, kPatience, [&] { return state_->running == 0; });
    }
    for (std::thread& thread : threads_)
        ended ? thread.join() : thread.detach();
}

void TracerPool::begin(std::shared_ptr<PassWork> pass) {
    const std::scoped_lock lock(state_->mutex);
    state_->queue.clear();
    state_->pass = std::move(pass);
}

void TracerPool::add(std::span<const WorkUnit> units) {
    {
        const std::scoped_lock lock(state_->mutex);
        state_->queue.insert(state_->queue.end(), units.begin(), units.end());
    }
    state_->changed.notify_all();
}

void TracerPool::cancel() {
    const std::scoped_lock lock(state_->mutex);
    state_->queue.clear();
}

void TracerPool::drop(std::span<const WorkUnit> units) {
    const std::scoped_lock lock(state_->mutex);
    std::erase_if(state_->queue,
                  [&](const WorkUnit& unit) { return std::find(units.begin(), units.end(), unit) != units.end(); });
}

std::uint64_t TracerPool::queued_weight() const {
    const std::scoped_lock lock(state_->mutex);
    std::uint64_t sum = 0;
    for (const WorkUnit& unit : state_->queue)
        sum += weight(unit);
    return sum;
}

std::size_t TracerPool::queued() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->queue.size();
}

bool TracerPool::idle() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->queue.empty() && state_->running == 0;
}

std::optional<std::string> TracerPool::failure() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->failure;
}

void TracerPool::run(State& state) {
    UnitOutput output;
    std::unique_lock lock(state.mutex);
    for (;;) {
        state.changed.wait(lock, [&] { return state.stop || !state.queue.empty(); });
        if (state.stop) return;
        const WorkUnit unit = state.queue.front();
        state.queue.pop_front();
        const std::shared_ptr<PassWork> pass = state.pass;
        ++state.running;
        lock.unlock();
        std::optional<std::string> failure;
        try {
            trace(state, *pass, unit, output);
        } catch (const std::exception& error) {
            failure = error.what();
        }
        lock.lock();
        --state.running;
        if (failure) {
            state.failure = failure;
            state.queue.clear();
        }
        if (state.stop) state.changed.notify_all();
    }
}

void TracerPool::trace(State& state, PassWork& pass, const WorkUnit& unit, UnitOutput& output) {
    const Timer timer;
    output.begin(pass.guide(), pass.plan().layers.splats);
    state.render(pass.plan(), pass.guide(), unit, output);
    output.stats.busy_seconds += timer.seconds();
    state.samples += output.stats.paths;
    state.rays += output.stats.rays + output.stats.shadow_rays;
    pass.deliver(unit, output);
}

}  // namespace treefarm
