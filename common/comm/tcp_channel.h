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

/// How guests are taken in.
struct GuestOptions {
    std::string address = "127.0.0.1";         ///< of this machine, to listen at
    std::uint16_t port = 0;                    ///< 0: the kernel chooses one
    std::uint64_t fingerprint = 0;             ///< that guests must have
    std::function<void(std::string)> warning;  ///< one line about who was turned away
};

/// Limits of what connections may cost.
struct GuestLimits {
    std::size_t most_unproven = 64;                    ///< connections that have not proved to have the secret
    double unproven_seconds = 5;                       ///< so long may each be so
    std::size_t most_unsent = std::size_t{256} << 20;  ///< bytes that may wait for a guest ...
    double unsent_seconds = 10;                        ///< ... if they do not become fewer in so long
};

/// The coordinator's connections to guests. Peers are those that have proved to have the secret; they get numbers from
/// `first_peer` on, and each is closed and forgotten at the first frame that is not its own. No call waits for anybody.
class TcpChannel final : public Channel {
  public:
    using Clock = std::function<double()>;  ///< seconds

    /// Listens. Throws InputError.
    TcpChannel(const GuestOptions& options, int first_peer, const GuestLimits& limits = {}, Clock clock = {});
    ~TcpChannel() override;

    /// Way in; its address is one that others can reach where `options.address` means all of this machine's.
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
    /// Sends what it can, and lets in who knocks.
    bool drained() override;
    void rest(double seconds) override;
    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return received_; }

    /// Takes a connection as if it had been accepted.
    void adopt(Socket socket, const std::string& from);
    /// Connections that have not proved anything yet.
    std::size_t unproven() const { return visitors_.size(); }

    /// Sends what is queued, says that nothing more will come, and waits for guests to close, up to so many seconds.
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
            std::size_t bytes;  ///< that were unsent then
            double since;
        };
        std::optional<Behind> behind;
    };

    bool wait(double seconds, bool reading) const;
    void accept_all();
    std::string hear(Visitor& visitor);
    bool see_to(Visitor& visitor, bool ready);
    void move(bool reading);
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
    int last_heard_ = 0;  ///< whose message poll() returned last: others come first
    std::vector<std::uint8_t> scratch_;
    std::uint64_t sent_ = 0, received_ = 0;
    int warnings_ = 0;
};

/// A guest's channel to the coordinator, peer 0: connects and proves itself. Throws InputError with what to do where it
/// is turned away or nobody answers.
std::unique_ptr<Channel> join_run(const JoinTicket& ticket, std::uint64_t fingerprint);

}  // namespace treefarm
