// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/comm/channel.h"
#include "common/comm/tcp_channel.h"

namespace treefarm {

/// The coordinator's channel where workers may join: the peers of another channel under their own numbers, and guests
/// under the numbers behind. Costs nothing until guests are taken.
class MultiChannel final : public Channel {
  public:
    /// `base` outlives this, and its number of peers stays.
    explicit MultiChannel(Channel& base) : base_(base) {}
    /// Hangs up on guests that have not left.
    ~MultiChannel() override;

    int self() const override { return base_.self(); }
    int peer_count() const override { return guests_ ? guests_->peer_count() : base_.peer_count(); }
    std::vector<int> peers() const override;
    bool is_open(int peer) const override { return is_guest(peer) ? guests_->is_open(peer) : base_.is_open(peer); }
    bool is_guest(int peer) const override { return guests_ && guests_->is_guest(peer); }
    std::size_t unsent(int peer) const override { return is_guest(peer) ? guests_->unsent(peer) : 0; }
    /// Listens from the first call on; later ones return the same ticket.
    const JoinTicket& take_guests(const GuestOptions& options) override;
    bool takes_guests() const override { return guests_ != nullptr; }
    void send(int peer, Payload payload) override;
    std::optional<Received> poll() override;
    bool drained() override;
    void rest(double seconds) override;
    std::uint64_t bytes_sent() const override;
    std::uint64_t bytes_received() const override;

    /// Lets guests go, once they have been told to leave: sends what is queued, and waits a moment for them to close.
    void close();

  private:
    Channel& base_;
    std::unique_ptr<TcpChannel> guests_;
    bool guests_first_ = false;  ///< turns with each poll: nobody is heard at the cost of others
};

}  // namespace treefarm
