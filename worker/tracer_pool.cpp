// SPDX-License-Identifier: Apache-2.0
#include "worker/tracer_pool.h"

#include <algorithm>
#include <exception>

namespace treefarm {

TracerPool::TracerPool(unsigned threads, RenderUnit render) : render_(std::move(render)) {
    try {
        for (unsigned t = 0; t < threads; ++t)
            threads_.emplace_back([this] { run(); });
    } catch (...) {  // thread creation failed: threads already running must not outlive the pool
        stop();
        throw;
    }
}

TracerPool::~TracerPool() {
    stop();
}

void TracerPool::stop() {
    {
        const std::scoped_lock lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void TracerPool::begin(std::shared_ptr<PassWork> pass) {
    const std::scoped_lock lock(mutex_);
    queue_.clear();
    pass_ = std::move(pass);
}

void TracerPool::add(std::span<const WorkUnit> units) {
    {
        const std::scoped_lock lock(mutex_);
        queue_.insert(queue_.end(), units.begin(), units.end());
    }
    changed_.notify_all();
}

void TracerPool::cancel() {
    const std::scoped_lock lock(mutex_);
    queue_.clear();
}

void TracerPool::drop(std::span<const WorkUnit> units) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(queue_,
                  [&](const WorkUnit& unit) { return std::find(units.begin(), units.end(), unit) != units.end(); });
}

std::uint64_t TracerPool::queued_weight() const {
    const std::scoped_lock lock(mutex_);
    std::uint64_t sum = 0;
    for (const WorkUnit& unit : queue_)
        sum += weight(unit);
    return sum;
}

std::size_t TracerPool::queued() const {
    const std::scoped_lock lock(mutex_);
    return queue_.size();
}

bool TracerPool::idle() const {
    const std::scoped_lock lock(mutex_);
    return queue_.empty() && running_ == 0;
}

std::optional<std::string> TracerPool::failure() const {
    const std::scoped_lock lock(mutex_);
    return failure_;
}

void TracerPool::run() {
    UnitOutput output;
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return stop_ || !queue_.empty(); });
        if (stop_) return;
        const WorkUnit unit = queue_.front();
        queue_.pop_front();
        const std::shared_ptr<PassWork> pass = pass_;
        ++running_;
        lock.unlock();
        std::optional<std::string> failure;
        try {
            trace(*pass, unit, output);
        } catch (const std::exception& error) {
            failure = error.what();
        }
        lock.lock();
        --running_;
        if (failure) {
            failure_ = failure;
            queue_.clear();
        }
    }
}

void TracerPool::trace(PassWork& pass, const WorkUnit& unit, UnitOutput& output) {
    output.begin(pass.guide().regions().distribution_count(), pass.plan().layers.splats);
    render_(pass.plan(), pass.guide(), unit, output);
    samples_ += output.stats.paths;
    rays_ += output.stats.rays + output.stats.shadow_rays;
    pass.deliver(unit, output);
}

}  // namespace treefarm
