// SPDX-License-Identifier: Apache-2.0
#include "serve/bounded_queue.h"

#include <utility>

namespace treefarm {

BoundedQueue::BoundedQueue(std::size_t threads, std::size_t waiting) : most_(waiting) {
    for (std::size_t k = 0; k < threads; ++k)
        threads_.emplace_back([this] { work(); });
}

void BoundedQueue::enqueue(std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        if (tasks_.size() < most_) {
            tasks_.push_back(std::move(task));
            changed_.notify_one();
            return;
        }
    }
    task();
}

void BoundedQueue::shutdown() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

void BoundedQueue::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
        if (tasks_.empty()) return;
        const std::function<void()> task = std::move(tasks_.front());
        tasks_.pop_front();
        lock.unlock();
        task();
        lock.lock();
    }
}

}  // namespace treefarm
