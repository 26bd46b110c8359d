// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/comm/rest.h"
#include "common/protocol/messages.h"
#include "coordinator/farm/farm.h"

namespace treefarm {

bool dismiss_workers(Channel& channel, const std::set<int>& lost, double patience) {
    const std::vector<int> told = channel.peers();
    tell_workers(channel, Quit{});
    std::set<int> gone;
    const auto are_gone = [&](const auto& is_excused) {
        return std::all_of(told.begin(), told.end(),
                           [&](int peer) { return gone.contains(peer) || !channel.is_open(peer) || is_excused(peer); });
    };
    const Timer timer;
    while (!are_gone([&](int peer) { return lost.contains(peer); }) && timer.seconds() < patience) {
        if (const auto message = channel.poll()) {
            try {
                if (std::holds_alternative<Bye>(decode(message->bytes))) gone.insert(message->peer);
            } catch (const std::exception&) {  // whatever it was, nobody needs it any more
            }
        } else {
            rest(channel);
        }
    }
    const bool orderly = are_gone([&](int peer) { return channel.is_guest(peer); });
    tell_workers(channel, Leave{orderly});
    return orderly;
}

}  // namespace treefarm
