// SPDX-License-Identifier: Apache-2.0
#include "common/comm/multi_channel.h"

#include <algorithm>

namespace treefarm {

namespace {

/// Seconds that guests have to leave.
constexpr double kCloseSeconds = 2.0;

/// Longest pause during a transfer to a guest, which advances only when polled.
constexpr double kMovingSeconds = 200e-6;

}  // namespace

MultiChannel::~MultiChannel() = default;

std::vector<int> MultiChannel::peers() const {
    std::vector<int> peers = base_.peers();
    if (!guests_) return peers;
    const std::vector<int> guests = guests_->peers();
    peers.insert(peers.end(), guests.begin(), guests.end());
    return peers;
}

const JoinTicket& MultiChannel::take_guests(const GuestOptions& options) {
    if (!guests_) guests_ = std::make_unique<TcpChannel>(options, base_.peer_count());
    return guests_->ticket();
}

void MultiChannel::send(int peer, Payload payload) {
    if (is_guest(peer))
        guests_->send(peer, std::move(payload));
    else
        base_.send(peer, std::move(payload));
}

std::optional<Received> MultiChannel::poll() {
    if (!guests_) return base_.poll();
    guests_first_ = !guests_first_;
    if (guests_first_) {
        if (auto message = guests_->poll()) return message;
        return base_.poll();
    }
    if (auto message = base_.poll()) return message;
    return guests_->poll();
}

bool MultiChannel::drained() {
    const bool guests = !guests_ || guests_->drained();
    return base_.drained() && guests;
}

void MultiChannel::rest(double seconds) {
    if (guests_ && guests_->has_unsent())
        guests_->rest(std::min(seconds, kMovingSeconds));
    else
        base_.rest(seconds);
}

std::uint64_t MultiChannel::bytes_sent() const {
    return base_.bytes_sent() + (guests_ ? guests_->bytes_sent() : 0);
}

std::uint64_t MultiChannel::bytes_received() const {
    return base_.bytes_received() + (guests_ ? guests_->bytes_received() : 0);
}

void MultiChannel::close() {
    if (guests_) guests_->close(kCloseSeconds);
}

}  // namespace treefarm
