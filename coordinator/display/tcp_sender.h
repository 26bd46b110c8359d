// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>

#include "common/comm/tcp_socket.h"

namespace treefarm {

/// A send-only TCP connection with time limits on every wait. Throws std::runtime_error with the cause in a few words.
class TcpSender {
  public:
    /// Connects within `seconds`, not counting the name look-up. `stopping`: true ends any wait.
    TcpSender(const std::string& host, std::uint16_t port, double seconds, const std::atomic<bool>& stopping)
        : socket_(connect_to(host, port, seconds, [&] { return stopping.load(); })), stopping_(stopping) {}

    /// Sends all bytes; throws if none is accepted for `seconds`.
    void send(std::span<const std::uint8_t> bytes, double seconds);

  private:
    void wait(double seconds);

    Socket socket_;
    const std::atomic<bool>& stopping_;
};

}  // namespace treefarm
