// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>

namespace treefarm {

/// A connection that only sends, and waits for nobody longer than it was told to. Throws std::runtime_error with what
/// went wrong, in a few words.
class TcpSender {
  public:
    /// Connects within `seconds`, the look-up of the name not counted. `stopping`: ends any wait once it is true.
    TcpSender(const std::string& host, const std::string& port, double seconds, const std::atomic<bool>& stopping);
    ~TcpSender();
    TcpSender(const TcpSender&) = delete;
    TcpSender& operator=(const TcpSender&) = delete;

    /// Sends all bytes; gives up where none is taken for `seconds`.
    void send(std::span<const std::uint8_t> bytes, double seconds);

  private:
    void wait(double seconds);

    int socket_ = -1;
    const std::atomic<bool>& stopping_;
};

}  // namespace treefarm
