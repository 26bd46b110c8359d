// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>

#include "common/comm/tcp_socket.h"

namespace treefarm {

/// A connection that only sends, and waits for nobody longer than it was told to. Throws std::runtime_error with what
/// went wrong, in a few words.
class TcpSender {
  public:
    /// Connects within `seconds`, the look-up of the name not counted. `stopping`: ends any wait once it is true.
    TcpSender(const std::string& host, std::uint16_t port, double seconds, const std::atomic<bool>& stopping)
        : socket_(connect_to(host, port, seconds, [&] { return stopping.load(); })), stopping_(stopping) {}

    /// Sends all bytes; gives up where none is taken for `seconds`.
    void send(std::span<const std::uint8_t> bytes, double seconds);

  private:
    void wait(double seconds);

    Socket socket_;
    const std::atomic<bool>& stopping_;
};

}  // namespace treefarm
