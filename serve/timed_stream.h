// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <array>
#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include "common/base/timer.h"
#include "serve/web_server.h"

namespace treefarm {

/// A client's connection with one time limit for a whole request and one for a whole response, however slowly their
/// bytes arrive: httplib's own limits restart with each byte.
class TimedStream final : public httplib::Stream {
  public:
    /// `stopping`: true ends any wait. `others_wait`: whether the time of a response is short. `limits` and `stopping`
    /// must outlive the stream.
    TimedStream(int socket, const WebLimits& limits, const std::atomic<bool>& stopping,
                std::function<bool()> others_wait)
        : socket_(socket), limits_(limits), stopping_(stopping), others_wait_(std::move(others_wait)) {}

    bool is_readable() const override { return begin_ < end_; }
    bool is_writable() const override { return true; }
    ssize_t read(char* to, std::size_t size) override;
    ssize_t write(const char* from, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return socket_; }

    /// Ends the connection: signals its end, and reads what is in transit for a moment. An immediate close would reset
    /// it and might lose the client's response.
    void end();

  private:
    bool wait(short events, const Timer& timer, double seconds) const;
    bool has_time_to_write() const;

    const int socket_;
    const WebLimits& limits_;
    const std::atomic<bool>& stopping_;
    const std::function<bool()> others_wait_;
    Timer reading_, writing_;
    bool wrote_ = false;
    std::array<char, 4096> buffer_{};
    std::size_t begin_ = 0, end_ = 0;  ///< range of unread bytes in the buffer
    std::size_t received_ = 0;
};

}  // namespace treefarm
