// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/comm/channel.h"

namespace treefarm {

/// Channels between `peers` threads of one process, connected by queues: [0] is the coordinator's, [k] worker k's. Each
/// may be used by one thread at a time; they may be destroyed in any order.
std::vector<std::unique_ptr<Channel>> make_in_process_channels(int peers);

}  // namespace treefarm
