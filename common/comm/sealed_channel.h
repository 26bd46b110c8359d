// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/comm/channel.h"
#include "common/comm/frames.h"

namespace treefarm {

/// Authenticated channel between peers that share a secret, over a channel that is open to others. Each message follows
/// its frame head (frames.h), under a separate key for each pair and direction. After a message that was changed,
/// repeated, omitted or forged, a peer is ignored: it delivers one empty message and is silent from then on, like a
/// lost peer.
class SealedChannel final : public Channel {
  public:
    /// `base` must outlive this. `nonces`: of all peers, by number, drawn anew for each session; if they are changed in
    /// transit, all messages fail.
    SealedChannel(Channel& base, const JoinKey& secret, std::span<const JoinKey> nonces);

    int self() const override { return base_.self(); }
    int peer_count() const override { return base_.peer_count(); }
    bool is_open(int peer) const override { return base_.is_open(peer); }
    void send(int peer, Payload payload) override;
    std::optional<Received> poll() override;
    bool drained() override { return base_.drained(); }
    void rest(double seconds) override { base_.rest(seconds); }
    std::uint64_t bytes_sent() const override { return base_.bytes_sent(); }
    std::uint64_t bytes_received() const override { return base_.bytes_received(); }

  private:
    struct Direction {
        JoinKey key{};
        std::uint64_t sequence = 0;
    };
    struct Peer {
        Direction to, from;
        std::optional<FrameHead> head;  ///< of the message to come
        bool broken = false;
    };

    static bool take_head(Peer& peer, const Bytes& bytes);

    Channel& base_;
    std::vector<Peer> peers_;
};

}  // namespace treefarm
