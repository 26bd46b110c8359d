// SPDX-License-Identifier: Apache-2.0
#include "common/comm/rest.h"
#include "common/protocol/messages.h"
#include "coordinator/farm.h"

namespace treefarm {

bool dismiss_workers(Channel& channel, const std::set<int>& lost, double patience) {
    tell_workers(channel, Quit{});
    std::set<int> gone;
    const auto count_gone = [&](bool lost_ones) {
        int count = 0;
        for (int peer = 1; peer < channel.peer_count(); ++peer)
            count += gone.contains(peer) || (lost_ones && lost.contains(peer));
        return count;
    };
    const int workers = channel.peer_count() - 1;
    const Timer timer;
    while (count_gone(true) < workers && timer.seconds() < patience) {
        if (const auto message = channel.poll()) {
            try {
                if (std::holds_alternative<Bye>(decode(message->bytes))) gone.insert(message->peer);
            } catch (const std::exception&) {  // whatever it was, nobody needs it any more
            }
        } else {
            rest(channel);
        }
    }
    const bool orderly = count_gone(false) == workers;
    tell_workers(channel, Leave{orderly});
    return orderly;
}

}  // namespace treefarm
