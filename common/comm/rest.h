// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

#include "common/comm/channel.h"

namespace treefarm {

/// Pause between two polls for messages. `calm`: no answer is urgent, so polls may be rare; each takes time from a
/// tracing thread.
inline void rest(Channel& channel, bool calm = false) {
    constexpr std::chrono::milliseconds kCalm{8};
    constexpr double kShortSeconds = 2e-3;
    if (calm && channel.drained())
        std::this_thread::sleep_for(kCalm);
    else
        channel.rest(kShortSeconds);
}

}  // namespace treefarm
