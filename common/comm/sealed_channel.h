// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/comm/channel.h"
#include "common/comm/frames.h"

namespace treefarm {

/// A channel between peers that share a secret, over another that anybody may reach: each message follows its frame
/// head (frames.h), under a key of its own for each pair and direction. A peer of which one message was changed,
/// repeated, left out or made up is heard no more: it sends one message in which there is nothing, and its own silence
/// afterwards is that of a lost one.
class SealedChannel final : public Channel {
  public:
    /// `base` outlives this. `nonces`: of all peers, by number, drawn for each session anew; whoever changes them on
    /// their way gets one whose messages all fail.
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
        std::optional<FrameHead> head;  ///< of the message that comes next
        bool broken = false;
    };

    static bool take_head(Peer& peer, const Bytes& bytes);

    Channel& base_;
    std::vector<Peer> peers_;
};

}  // namespace treefarm
