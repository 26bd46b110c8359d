// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/comm/channel.h"

namespace treefarm {

/// Channels of `peers` threads of one process, joined by queues: [0] is the coordinator's, [k] worker k's. Each may be
/// used by one thread at a time; they may outlive each other.
std::vector<std::unique_ptr<Channel>> make_in_process_channels(int peers);

}  // namespace treefarm
