// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/comm/channel.h"
#include "common/comm/handshake.h"
#include "common/comm/tcp_link.h"

namespace treefarm {

/// Settings of accepting guests.
struct GuestOptions {
    std::string address = "127.0.0.1";         ///< address of this machine at which to listen
    std::uint16_t port = 0;                    ///< 0: chosen by the kernel
    std::uint64_t fingerprint = 0;             ///< required of guests
    std::function<void(std::string)> warning;  ///< receives one line about a refused connection
};

/// Limits of connections.
struct GuestLimits {
    std::size_t most_unproven = 64;  ///< unauthenticated connections at a time; one more closes the oldest
    double unproven_seconds = 5;     ///< seconds that a connection may stay unauthenticated
    std::size_t most_unsent = std::size_t{256} << 20;  ///< queued bytes beyond which a guest is closed ...
    double unsent_seconds = 10;                        ///< ... unless they decrease within this time
};

/// The coordinator's connections to guests. A connection becomes a peer when it has proved to know the secret; numbers
/// begin at `first_peer`. A guest is closed and removed at the first invalid frame. No call waits.
class TcpChannel final : public Channel {
  public:
    using Clock = std::function<double()>;  ///< seconds

    /// Starts to listen. Throws InputError.
    TcpChannel(const GuestOptions& options, int first_peer, const GuestLimits& limits = {}, Clock clock = {});
    ~TcpChannel() override;

    /// Ticket for guests. Its address can be reached from other hosts if `options.address` means all of this machine's.
    const JoinTicket& ticket() const { return ticket_; }

    int self() const override { return 0; }
    int peer_count() const override { return next_peer_; }
    std::vector<int> peers() const override;
    bool is_open(int peer) const override { return links_.contains(peer); }
    bool is_guest(int peer) const override { return peer >= first_peer_; }
    std::size_t unsent(int peer) const override;
    bool has_unsent() const;
    bool takes_guests() const override { return true; }
    void send(int peer, Payload payload) override;
    std::optional<Received> poll() override;
    /// Sends queued data and accepts new connections. True if all data have left.
    bool drained() override;
    void rest(double seconds) override;
    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return received_; }

    /// Takes a connection as if it had been accepted.
    void adopt(Socket socket, const std::string& from);
    /// Number of unauthenticated connections.
    std::size_t unproven() const { return visitors_.size(); }

    /// Sends queued data, announces the end, and waits for guests to close, at most `seconds`.
    void close(double seconds);

  private:
    struct Visitor {
        Socket socket;
        std::string from;
        double since;
        ListenerHandshake handshake;
    };
    struct Guest {
        TcpLink link;
        std::string from;
        struct Behind {
            std::size_t bytes;  ///< queued bytes at that time
            double since;
        };
        std::optional<Behind> behind;
    };

    bool wait(double seconds, bool reading) const;
    void accept_all();
    std::string hear(Visitor& visitor);
    bool see_to(Visitor& visitor, bool ready);
    void move(bool reading);
    void push_out();
    void give_up_slow(Guest& guest);
    void warn(const std::string& text);

    const GuestOptions options_;
    const GuestLimits limits_;
    const Clock clock_;
    const int first_peer_;
    int next_peer_;
    Listener listener_;
    JoinTicket ticket_;
    std::list<Visitor> visitors_;
    std::map<int, Guest> links_;
    int last_heard_ = 0;  ///< peer of the last message of poll(); the others come first
    std::vector<std::uint8_t> scratch_;
    std::uint64_t sent_ = 0, received_ = 0;
    int warnings_ = 0;
};

/// Channel of a guest to the coordinator, peer 0: connects and authenticates itself. Throws InputError with a cure if
/// it is refused or gets no answer.
std::unique_ptr<Channel> join_run(const JoinTicket& ticket, std::uint64_t fingerprint);

}  // namespace treefarm
