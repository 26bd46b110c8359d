// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/pulse.h"

#include <chrono>
#include <future>

#include "coordinator/farm/farm.h"

namespace treefarm {

void run_in_background(const std::function<void()>& work, const std::function<void()>& meanwhile) {
    constexpr std::chrono::milliseconds kPause{10};
    std::future<void> done = std::async(std::launch::async, work);
    while (done.wait_for(kPause) != std::future_status::ready)
        meanwhile();
    done.get();
}

void Pulse::beat() {
    constexpr double kSeconds = 1.0;
    if (clock_.seconds() - last_ < kSeconds) return;
    last_ = clock_.seconds();
    tell_workers(channel_, Heartbeat{});
}

}  // namespace treefarm
