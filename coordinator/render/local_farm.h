// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "common/comm/multi_channel.h"

namespace treefarm {

/// Runs a worker at its end of a channel until it is dismissed; throws nothing. Coordinator and worker never include
/// each other, so who has both gives the one to the other (worker/local_worker.h).
using LocalWorker = std::function<void(Channel& own)>;

/// A farm of one worker, in a thread of this process, which is dismissed at the end.
class LocalFarm {
  public:
    explicit LocalFarm(LocalWorker work);
    ~LocalFarm();
    LocalFarm(const LocalFarm&) = delete;
    LocalFarm& operator=(const LocalFarm&) = delete;

    /// The coordinator's end.
    Channel& channel() { return channel_; }

  private:
    const std::vector<std::unique_ptr<Channel>> ends_;
    MultiChannel channel_;
    std::thread worker_;
};

}  // namespace treefarm
