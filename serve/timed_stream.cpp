// SPDX-License-Identifier: Apache-2.0
#include "serve/timed_stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace treefarm {

namespace {

constexpr double kSlice = 0.05, kLinger = 0.3;

}  // namespace

/// Waits until the socket is ready; false at the end of the time.
bool TimedStream::wait(short events, const Timer& timer, double seconds) const {
    while (!stopping_) {
        const double left = seconds - timer.seconds();
        if (left <= 0) return false;
        pollfd ready{socket_, events, 0};
        const int found = ::poll(&ready, 1, std::max(1, static_cast<int>(1000 * std::min(left, kSlice))));
        if (found > 0) return true;
        if (found < 0 && errno != EINTR) return false;
    }
    return false;
}

ssize_t TimedStream::read(char* to, std::size_t size) {
    if (begin_ == end_) {
        if (received_ >= limits_.request_bytes) return -1;
        ssize_t got = -1;
        do {
            if (!wait(POLLIN, reading_, limits_.request_seconds)) return -1;
            got = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
        } while (got < 0 && (errno == EAGAIN || errno == EINTR));
        if (got <= 0) return got;
        begin_ = 0;
        end_ = static_cast<std::size_t>(got);
        received_ += end_;
    }
    const std::size_t count = std::min(size, end_ - begin_);
    std::memcpy(to, buffer_.data() + begin_, count);
    begin_ += count;
    return static_cast<ssize_t>(count);
}

bool TimedStream::has_time_to_write() const {
    const double seconds = writing_.seconds();
    return seconds < limits_.response_seconds && (seconds < limits_.request_seconds || !others_wait_());
}

ssize_t TimedStream::write(const char* from, std::size_t size) {
    if (!wrote_) writing_.restart();
    wrote_ = true;
    while (has_time_to_write()) {
        const ssize_t sent = ::send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (sent >= 0) return sent;
        if (errno != EAGAIN && errno != EINTR) return -1;
        const Timer pause;
        if (!wait(POLLOUT, pause, kSlice) && stopping_) return -1;
    }
    return -1;
}

void TimedStream::end() {
    ::shutdown(socket_, SHUT_WR);
    const Timer timer;
    for (std::size_t taken = 0; taken < limits_.request_bytes && wait(POLLIN, timer, kLinger);) {
        const ssize_t got = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
        if (got <= 0) return;
        taken += static_cast<std::size_t>(got);
    }
}

// Unused by the site.
void TimedStream::get_remote_ip_and_port(std::string& ip, int& port) const {
    ip.clear();
    port = 0;
}

void TimedStream::get_local_ip_and_port(std::string& ip, int& port) const {
    ip.clear();
    port = 0;
}

}  // namespace treefarm
