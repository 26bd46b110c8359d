// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "common/comm/multi_channel.h"

namespace treefarm {

/// Function that runs a worker at its end of a channel until it is dismissed; throws nothing. Coordinator and worker
/// never include each other, so that the caller, who has both, passes the worker to the coordinator
/// (worker/local_worker.h).
using LocalWorker = std::function<void(Channel& own)>;

/// Farm of one worker in a thread of this process, dismissed by the destructor.
class LocalFarm {
  public:
    explicit LocalFarm(LocalWorker work);
    ~LocalFarm();
    LocalFarm(const LocalFarm&) = delete;
    LocalFarm& operator=(const LocalFarm&) = delete;

    /// Coordinator's end of the channel.
    Channel& channel() { return channel_; }

  private:
    const std::vector<std::unique_ptr<Channel>> ends_;
    MultiChannel channel_;
    std::thread worker_;
};

}  // namespace treefarm
