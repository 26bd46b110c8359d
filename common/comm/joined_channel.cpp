// SPDX-License-Identifier: Apache-2.0
// The guest's end: connects, authenticates itself, and is a channel from then on.
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cmath>
#include <memory>

#include "common/base/error.h"
#include "common/base/timer.h"
#include "common/comm/tcp_channel.h"

namespace treefarm {

namespace {

constexpr double kConnectSeconds = 10, kAnswerSeconds = 10;

/// Peer numbers on a guest's own channel, which has only the coordinator.
constexpr int kSelf = 1, kPeers = 2;

bool wait_for(int fd, short events, double seconds) {
    pollfd ready{fd, events, 0};
    const double whole = std::floor(seconds);
    const timespec time{static_cast<time_t>(whole), static_cast<long>((seconds - whole) * 1e9)};
    return ::ppoll(&ready, 1, &time, nullptr) > 0;
}

class JoinedChannel final : public Channel {
  public:
    explicit JoinedChannel(TcpLink link) : link_(std::move(link)), scratch_(kScratchBytes) {}

    int self() const override { return kSelf; }
    int peer_count() const override { return kPeers; }
    bool is_open(int) const override { return link_.is_open() || link_.has_message(); }
    std::size_t unsent(int) const override { return link_.unsent(); }

    void send(int peer, Payload payload) override {
        if (peer != 0) return;
        sent_ += payload->size();
        const bool idle = link_.unsent() == 0;
        link_.send(std::move(payload));
        if (idle) link_.write();
    }

    std::optional<Received> poll() override {
        if (!link_.has_message()) {
            link_.write();
            link_.read(scratch_);
        }
        auto message = link_.take();
        if (!message) return std::nullopt;
        received_ += message->size();
        return Received{0, std::move(*message)};
    }

    bool drained() override {
        link_.write();
        return link_.unsent() == 0;
    }

    void rest(double seconds) override {
        wait_for(link_.fd(), static_cast<short>(POLLIN | (link_.unsent() > 0 ? POLLOUT : 0)), seconds);
    }

    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return received_; }

  private:
    TcpLink link_;
    std::vector<std::uint8_t> scratch_;
    std::uint64_t sent_ = 0, received_ = 0;
};

[[noreturn]] void refuse(const JoinTicket& ticket, const std::string& what, const std::string& cure) {
    throw InputError(Location{ticket.address + " port " + std::to_string(ticket.port), 0, 0}, what, cure);
}

Socket knock(const JoinTicket& ticket) {
    try {
        return connect_to(ticket.address, ticket.port, kConnectSeconds);
    } catch (const RunError& error) {
        refuse(ticket, std::string("nobody answers: ") + error.what(),
               "see in status.json of the run directory whether the render still runs; farm.join_address has to be one "
               "that this machine can reach");
    }
}

}  // namespace

std::unique_ptr<Channel> join_run(const JoinTicket& ticket, std::uint64_t fingerprint) {
    Socket socket = knock(ticket);
    GuestHandshake handshake(ticket, fingerprint, draw_join_key());
    const Bytes& hello = handshake.hello();
    if (::send(socket.fd(), hello.data(), hello.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(hello.size()))
        refuse(ticket, "nothing can be sent over the connection", "try again");
    std::uint8_t scratch[1024];
    const Timer timer;
    while (!handshake.is_welcome()) {
        if (!wait_for(socket.fd(), POLLIN, kAnswerSeconds) || timer.seconds() > kAnswerSeconds)
            refuse(ticket, "the program at this address does not answer",
                   "take the file join from the run directory again");
        const ssize_t count = ::recv(socket.fd(), scratch, sizeof scratch, MSG_DONTWAIT);
        if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        if (count <= 0)
            refuse(ticket, "the program at this address closed the connection",
                   "take the file join from the run directory again");
        try {
            handshake.take(std::span(scratch).first(static_cast<std::size_t>(count)));
        } catch (const FormatError& error) {
            refuse(ticket, error.what(), "take the file join from the run directory again");
        }
        if (handshake.refusal() != JoinRefusal::none) {
            const RefusalText text = refusal_text(handshake.refusal());
            refuse(ticket, text.what, text.cure);
        }
    }
    return std::make_unique<JoinedChannel>(
        TcpLink(std::move(socket), handshake.sending_key(), handshake.take_reader()));
}

}  // namespace treefarm
