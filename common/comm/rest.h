// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

#include "common/comm/channel.h"

namespace treefarm {

/// Between two looks at messages. `calm`: nothing need be answered soon, so that looks are rare, since each takes a
/// moment from a thread that traces.
inline void rest(Channel& channel, bool calm = false) {
    constexpr std::chrono::milliseconds kCalm{8};
    constexpr double kShortSeconds = 2e-3;
    if (calm && channel.drained())
        std::this_thread::sleep_for(kCalm);
    else
        channel.rest(kShortSeconds);
}

}  // namespace treefarm
