// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <cerrno>

#include "common/comm/handshake.h"
#include "common/comm/tcp_socket.h"

namespace treefarm::test {

inline constexpr std::uint64_t kGuestBuild = 7;

/// A guest whose every byte the test decides on.
class RawConnection {
  public:
    explicit RawConnection(const JoinTicket& ticket)
        : handshake_(ticket, kGuestBuild, draw_join_key()), socket_(connect_to(ticket.address, ticket.port, 5)) {}

    void say(std::span<const std::uint8_t> bytes) {
        ASSERT_EQ(::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL), ssize_t(bytes.size()));
    }
    void say_hello() { say(handshake_.hello()); }
    /// Once the door has answered.
    void take_answer() {
        std::uint8_t bytes[200];
        const ssize_t count = ::recv(socket_.fd(), bytes, sizeof bytes, 0);
        ASSERT_GT(count, 0);
        handshake_.take(std::span(bytes).first(std::size_t(count)));
    }
    Bytes frame(const Bytes& bytes) {
        const FrameHead head = frame_head(handshake_.sending_key(), sequence_++, bytes, false);
        Bytes all(head.begin(), head.end());
        all.insert(all.end(), bytes.begin(), bytes.end());
        return all;
    }
    bool has_answer() {
        std::uint8_t byte;
        return ::recv(socket_.fd(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 1;
    }
    /// Whether the other end has hung up.
    bool is_cut_off() {
        std::uint8_t byte;
        return ::recv(socket_.fd(), &byte, 1, MSG_DONTWAIT) == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
    }
    bool is_welcome() const { return handshake_.is_welcome(); }
    JoinRefusal refusal() const { return handshake_.refusal(); }

  private:
    GuestHandshake handshake_;
    Socket socket_;
    std::uint64_t sequence_ = 0;
};

}  // namespace treefarm::test
