// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/tcp_sender.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "common/base/timer.h"

namespace treefarm {

namespace {

[[noreturn]] void fail(int code) {
    throw std::runtime_error(std::strerror(code));
}

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses look_up(const std::string& host, const std::string& port) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int code = getaddrinfo(host.c_str(), port.c_str(), &hints, &found); code != 0)
        throw std::runtime_error(gai_strerror(code));
    return {found, &freeaddrinfo};
}

}  // namespace

TcpSender::TcpSender(const std::string& host, const std::string& port, double seconds,
                     const std::atomic<bool>& stopping)
    : stopping_(stopping) {
    const Addresses addresses = look_up(host, port);
    std::string why = "no address";
    for (const addrinfo* address = addresses.get(); address; address = address->ai_next) {
        socket_ = ::socket(address->ai_family, address->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (socket_ < 0) continue;
        try {
            if (::connect(socket_, address->ai_addr, address->ai_addrlen) != 0) {
                if (errno != EINPROGRESS) fail(errno);
                wait(seconds);
                int code = 0;
                socklen_t size = sizeof code;
                getsockopt(socket_, SOL_SOCKET, SO_ERROR, &code, &size);
                if (code != 0) fail(code);
            }
            return;
        } catch (const std::runtime_error& error) {
            why = error.what();
            ::close(socket_);
            socket_ = -1;
        }
    }
    throw std::runtime_error(why);
}

TcpSender::~TcpSender() {
    if (socket_ >= 0) ::close(socket_);
}

/// Waits until something can be sent.
void TcpSender::wait(double seconds) {
    constexpr int kSliceMilliseconds = 50;
    const Timer timer;
    while (timer.seconds() < seconds) {
        if (stopping_) throw std::runtime_error("the render has ended");
        pollfd ready{socket_, POLLOUT, 0};
        if (::poll(&ready, 1, kSliceMilliseconds) > 0) return;
    }
    throw std::runtime_error("no answer in time");
}

void TcpSender::send(std::span<const std::uint8_t> bytes, double seconds) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0)
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        else if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            wait(seconds);
        else if (sent == 0 || errno != EINTR)
            fail(sent == 0 ? EPIPE : errno);
    }
}

}  // namespace treefarm
