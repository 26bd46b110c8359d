// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace treefarm {

/// Thread pool that answers requests, with a bounded queue: a task that finds it full is run by its caller at once.
class BoundedQueue final : public httplib::TaskQueue {
  public:
    BoundedQueue(std::size_t threads, std::size_t waiting);
    ~BoundedQueue() override { shutdown(); }

    void enqueue(std::function<void()> task) override;
    /// Ends the threads, once all waiting tasks are done.
    void shutdown() override;

  private:
    void work();

    const std::size_t most_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool ending_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace treefarm
