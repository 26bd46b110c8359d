// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/comm/channel.h"
#include "common/comm/tcp_channel.h"

namespace treefarm {

/// The coordinator's channel if workers may join: the peers of another channel under their own numbers, and guests
/// under the numbers after them. Costs nothing until guests are accepted.
class MultiChannel final : public Channel {
  public:
    /// `base` must outlive this, with a constant number of peers.
    explicit MultiChannel(Channel& base) : base_(base) {}
    /// Closes the connections of guests that have not left.
    ~MultiChannel() override;

    int self() const override { return base_.self(); }
    int peer_count() const override { return guests_ ? guests_->peer_count() : base_.peer_count(); }
    std::vector<int> peers() const override;
    bool is_open(int peer) const override { return is_guest(peer) ? guests_->is_open(peer) : base_.is_open(peer); }
    bool is_guest(int peer) const override { return guests_ && guests_->is_guest(peer); }
    std::size_t unsent(int peer) const override { return is_guest(peer) ? guests_->unsent(peer) : 0; }
    /// Starts listening at the first call; later calls return the same ticket.
    const JoinTicket& take_guests(const GuestOptions& options) override;
    bool takes_guests() const override { return guests_ != nullptr; }
    void send(int peer, Payload payload) override;
    std::optional<Received> poll() override;
    bool drained() override;
    void rest(double seconds) override;
    std::uint64_t bytes_sent() const override;
    std::uint64_t bytes_received() const override;

    /// Closes connections after guests were told to leave: sends what is queued, and waits briefly for them to close.
    void close();

  private:
    Channel& base_;
    std::unique_ptr<TcpChannel> guests_;
    bool guests_first_ = false;  ///< alternates with each poll, so that neither side starves the other
};

}  // namespace treefarm
