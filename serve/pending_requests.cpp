// SPDX-License-Identifier: Apache-2.0
#include "serve/pending_requests.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <string_view>
#include <utility>

#include "common/base/connection_limits.h"
#include "serve/web_server.h"

namespace treefarm {

namespace {

constexpr std::string_view kTooMany =
    "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 1\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";

/// Interval of looks at connections whose request has not arrived.
constexpr std::chrono::milliseconds kLook{5};

std::string address_of(int socket) {
    sockaddr_storage address{};
    socklen_t length = sizeof address;
    char host[NI_MAXHOST] = "";
    if (getpeername(socket, reinterpret_cast<sockaddr*>(&address), &length) == 0)
        (void)getnameinfo(reinterpret_cast<const sockaddr*>(&address), length, host, sizeof host, nullptr, 0,
                          NI_NUMERICHOST);
    return host;
}

}  // namespace

PendingRequests::PendingRequests(const WebLimits& limits, Answer answer)
    : limits_(limits), answer_(std::move(answer)), buffer_(limits.request_bytes) {
    for (std::size_t k = 0; k < limits.threads; ++k)
        threads_.emplace_back([this] { work(); });
    threads_.emplace_back([this] { watch(); });
}

PendingRequests::~PendingRequests() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_)
        thread.join();
    for (const Connection& connection : connections_)
        ::close(connection.socket);
}

void PendingRequests::add(int socket) {
    const std::lock_guard lock(mutex_);
    connections_.push_back({socket, address_of(socket)});
    look(connections_.back());
    if (connections_.back().socket < 0)
        connections_.pop_back();
    else if (is_kept_for_files(socket) || connections_.size() > limits_.waiting + limits_.threads)
        push_out();
    changed_.notify_all();
}

bool PendingRequests::waits() {
    const std::lock_guard lock(mutex_);
    return std::any_of(connections_.begin(), connections_.end(), [](const Connection& c) { return c.ready; });
}

/// Closes the oldest connection of the address with most, silent ones first.
void PendingRequests::push_out() {
    std::vector<std::string> addresses;
    std::vector<std::size_t> indices;
    for (const bool ready : {false, true}) {
        for (std::size_t k = 0; k < connections_.size(); ++k)
            if (connections_[k].ready == ready) {
                indices.push_back(k);
                addresses.push_back(connections_[k].address);
            }
        if (!indices.empty()) break;
    }
    const auto closed = connections_.begin() + std::ptrdiff_t(indices[connection_to_close(addresses)]);
    [[maybe_unused]] const ssize_t sent =
        ::send(closed->socket, kTooMany.data(), kTooMany.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    ::close(closed->socket);
    connections_.erase(closed);
}

/// Looks whether the head of a request has arrived; closes the socket of one that has ended or is too slow.
void PendingRequests::look(Connection& connection) {
    const ssize_t got = ::recv(connection.socket, buffer_.data(), buffer_.size(), MSG_PEEK | MSG_DONTWAIT);
    const std::string_view head(buffer_.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    connection.ready = head.size() == buffer_.size() || head.find("\r\n\r\n") != head.npos;
    const bool ended = got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
    if (connection.ready || (!ended && connection.age.seconds() < limits_.request_seconds)) return;
    ::close(std::exchange(connection.socket, -1));
}

void PendingRequests::watch() {
    std::unique_lock lock(mutex_);
    while (!ending_) {
        bool silent = false, ready = false;
        for (Connection& connection : connections_) {
            if (!connection.ready) look(connection);
            (connection.ready ? ready : silent) = true;
        }
        std::erase_if(connections_, [](const Connection& c) { return c.socket < 0; });
        if (ready) changed_.notify_all();
        if (silent)
            changed_.wait_for(lock, kLook, [this] { return ending_; });
        else
            changed_.wait(lock);
    }
}

void PendingRequests::work() {
    std::unique_lock lock(mutex_);
    const auto next = [this] {
        return std::find_if(connections_.begin(), connections_.end(), [](const Connection& c) { return c.ready; });
    };
    for (;;) {
        changed_.wait(lock, [&] { return ending_ || next() != connections_.end(); });
        if (ending_) return;
        const int socket = next()->socket;
        connections_.erase(next());
        lock.unlock();
        answer_(socket);
        lock.lock();
    }
}

}  // namespace treefarm
