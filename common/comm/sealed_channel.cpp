// SPDX-License-Identifier: Apache-2.0
#include "common/comm/sealed_channel.h"

#include <algorithm>
#include <utility>

#include "common/comm/keyed_hash.h"

namespace treefarm {

namespace {

JoinKey direction_key(const JoinKey& secret, std::span<const JoinKey> nonces, std::size_t from, std::size_t to) {
    ByteWriter writer;
    writer.put(static_cast<std::uint64_t>(from));
    writer.put(static_cast<std::uint64_t>(to));
    writer.put_bytes(nonces[from]);
    writer.put_bytes(nonces[to]);
    return keyed_hash(secret, "messages: key", writer.take());
}

}  // namespace

SealedChannel::SealedChannel(Channel& base, const JoinKey& secret, std::span<const JoinKey> nonces)
    : base_(base), peers_(nonces.size()) {
    const auto own = static_cast<std::size_t>(self());
    for (std::size_t peer = 0; peer < peers_.size(); ++peer) {
        peers_[peer].to.key = direction_key(secret, nonces, own, peer);
        peers_[peer].from.key = direction_key(secret, nonces, peer, own);
    }
}

void SealedChannel::send(int peer, Payload payload) {
    Direction& to = peers_.at(static_cast<std::size_t>(peer)).to;
    const FrameHead head = frame_head(to.key, to.sequence++, *payload, false);
    base_.send(peer, std::make_shared<const Bytes>(head.begin(), head.end()));
    base_.send(peer, std::move(payload));
}

std::optional<Received> SealedChannel::poll() {
    while (std::optional<Received> received = base_.poll()) {
        Peer& peer = peers_.at(static_cast<std::size_t>(received->peer));
        if (peer.broken) continue;
        if (!peer.head && take_head(peer, received->bytes)) continue;
        const auto head = std::exchange(peer.head, std::nullopt);
        if (head && is_head_of(*head, peer.from.key, peer.from.sequence, received->bytes)) {
            ++peer.from.sequence;
            return received;
        }
        peer.broken = true;
        return Received{received->peer, {}};
    }
    return std::nullopt;
}

/// Whether the bytes have the form of a head; its content is checked with the message.
bool SealedChannel::take_head(Peer& peer, const Bytes& bytes) {
    if (bytes.size() != kFrameHeadBytes) return false;
    std::copy(bytes.begin(), bytes.end(), peer.head.emplace().begin());
    return true;
}

}  // namespace treefarm
