// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/tcp_sender.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "common/base/timer.h"

namespace treefarm {

/// Waits until the socket accepts bytes.
void TcpSender::wait(double seconds) {
    constexpr int kSliceMilliseconds = 50;
    const Timer timer;
    while (timer.seconds() < seconds) {
        if (stopping_) throw std::runtime_error("the render has ended");
        pollfd ready{socket_.fd(), POLLOUT, 0};
        if (::poll(&ready, 1, kSliceMilliseconds) > 0) return;
    }
    throw std::runtime_error("no answer in time");
}

void TcpSender::send(std::span<const std::uint8_t> bytes, double seconds) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0)
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        else if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            wait(seconds);
        else if (sent == 0 || errno != EINTR)
            throw std::runtime_error(std::strerror(sent == 0 ? EPIPE : errno));
    }
}

}  // namespace treefarm
