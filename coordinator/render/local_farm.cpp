// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/local_farm.h"

#include <utility>

#include "common/comm/in_process_channel.h"
#include "coordinator/farm/farm.h"

namespace treefarm {

LocalFarm::LocalFarm(LocalWorker work)
    : ends_(make_in_process_channels(2)),
      channel_(*ends_[0]),
      worker_([&own = *ends_[1], work = std::move(work)] { work(own); }) {}

LocalFarm::~LocalFarm() {
    dismiss_workers(channel_, {}, FarmLimits().dismiss);
    channel_.close();
    worker_.join();
}

}  // namespace treefarm
