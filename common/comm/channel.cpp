// SPDX-License-Identifier: Apache-2.0
#include "common/comm/channel.h"

#include "common/base/error.h"

namespace treefarm {

std::vector<int> Channel::peers() const {
    std::vector<int> peers;
    for (int peer = 0; peer < peer_count(); ++peer)
        if (peer != self()) peers.push_back(peer);
    return peers;
}

const JoinTicket& Channel::take_guests(const GuestOptions&) {
    throw InputError(Location{"farm.join", 0, 0}, "workers cannot join this process", "leave farm.join away");
}

}  // namespace treefarm
