// SPDX-License-Identifier: Apache-2.0
#include "common/comm/tcp_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>

#include "common/base/error.h"
#include "common/base/timer.h"

namespace treefarm {

namespace {

constexpr unsigned kUserTimeoutMilliseconds = 8000;

struct FreeAddresses {
    void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// Addresses of a name; empty, with the reason.
Addresses look_up(const std::string& address, std::uint16_t port, int flags, std::string& why) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags | AI_NUMERICSERV;
    addrinfo* list = nullptr;
    const int error = getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &list);
    if (error != 0) why = error == EAI_SYSTEM ? std::strerror(errno) : gai_strerror(error);
    return Addresses(list);
}

template <class T>
void set_option(const Socket& socket, int level, int name, T value) {
    (void)setsockopt(socket.fd(), level, name, &value, sizeof value);
}

Socket open_socket(const addrinfo& at) {
    return Socket(::socket(at.ai_family, at.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, at.ai_protocol));
}

std::string name_of(const sockaddr_storage& address, socklen_t length) {
    char host[NI_MAXHOST] = "", port[NI_MAXSERV] = "";
    if (getnameinfo(reinterpret_cast<const sockaddr*>(&address), length, host, sizeof host, port, sizeof port,
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0)
        return "somewhere";
    return std::string(host) + " port " + port;
}

std::uint16_t port_of(const Socket& socket) {
    sockaddr_storage address{};
    socklen_t length = sizeof address;
    if (getsockname(socket.fd(), reinterpret_cast<sockaddr*>(&address), &length) != 0) return 0;
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

/// Waits for a connection to be established. Returns 0 or the errno of the failure.
int await_connection(const Socket& socket, double seconds, const std::function<bool()>& stopped) {
    constexpr double kLookSeconds = 0.05;
    const Timer timer;
    pollfd ready{socket.fd(), POLLOUT, 0};
    for (int count = 0; count == 0;) {
        const double left = seconds - timer.seconds();
        if (left <= 0) return ETIMEDOUT;
        if (stopped && stopped()) return ECANCELED;
        count = ::poll(&ready, 1, static_cast<int>(std::ceil(1000 * std::min(left, kLookSeconds))));
        if (count < 0) return errno;
    }
    int error = 0;
    socklen_t length = sizeof error;
    return getsockopt(socket.fd(), SOL_SOCKET, SO_ERROR, &error, &length) == 0 ? error : errno;
}

}  // namespace

Listener listen_at(const std::string& address, std::uint16_t port) {
    std::string why;
    const Addresses addresses = look_up(address, port, AI_PASSIVE, why);
    if (!addresses)
        throw InputError(Location{"farm.join_address", 0, 0}, "\"" + address + "\" is no address here: " + why,
                         "name one of this machine, as ip address lists them, or 0.0.0.0 for all");
    Socket socket = open_socket(*addresses);
    set_option(socket, SOL_SOCKET, SO_REUSEADDR, 1);
    if (addresses->ai_family == AF_INET6) set_option(socket, IPPROTO_IPV6, IPV6_V6ONLY, 0);
    if (!socket || ::bind(socket.fd(), addresses->ai_addr, addresses->ai_addrlen) != 0 ||
        ::listen(socket.fd(), SOMAXCONN) != 0) {
        const std::string error = std::strerror(errno);
        if (errno == EADDRINUSE || errno == EACCES)
            throw InputError(Location{"farm.join_port", 0, 0},
                             "port " + std::to_string(port) + " of " + address + " cannot be listened at: " + error,
                             "choose another, or 0 for any that is free");
        throw InputError(Location{"farm.join_address", 0, 0}, address + " cannot be listened at: " + error,
                         "name an address of this machine, as ip address lists them, or 0.0.0.0 for all");
    }
    const std::uint16_t bound = port_of(socket);
    return {std::move(socket), bound};
}

std::optional<std::pair<Socket, std::string>> accept_from(const Socket& listener) {
    sockaddr_storage address{};
    socklen_t length = sizeof address;
    Socket socket(
        ::accept4(listener.fd(), reinterpret_cast<sockaddr*>(&address), &length, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) return std::nullopt;
    set_up(socket);
    return std::pair(std::move(socket), name_of(address, length));
}

Socket connect_to(const std::string& address, std::uint16_t port, double seconds,
                  const std::function<bool()>& stopped) {
    std::string why;
    const Addresses addresses = look_up(address, port, 0, why);
    for (const addrinfo* at = addresses.get(); at; at = at->ai_next) {
        Socket socket = open_socket(*at);
        if (!socket) {
            why = std::strerror(errno);
            continue;
        }
        int error = ::connect(socket.fd(), at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) error = await_connection(socket, seconds, stopped);
        if (error == 0) {
            set_up(socket);
            return socket;
        }
        why = std::strerror(error);
    }
    throw RunError(why);
}

void set_up(const Socket& socket) {
    (void)::fcntl(socket.fd(), F_SETFL, O_NONBLOCK);
    set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
    set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, kUserTimeoutMilliseconds);
}

}  // namespace treefarm
