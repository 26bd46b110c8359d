// SPDX-License-Identifier: Apache-2.0
#include "common/comm/tcp_link.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/base/error.h"

namespace treefarm {

namespace {

/// Bytes moved at a time, so that no connection delays the others.
constexpr std::size_t kMostMoved = std::size_t{1} << 20;

bool would_block(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace

TcpLink::TcpLink(Socket socket, const JoinKey& sending_key, FrameReader reader)
    : socket_(std::move(socket)), sending_key_(sending_key), reader_(std::move(reader)) {}

void TcpLink::close(const std::string& why) {
    if (closed_.empty()) closed_ = why;
    queue_.clear();
    unsent_ = 0;
}

void TcpLink::end_sending() {
    deaf_ = true;
    ::shutdown(socket_.fd(), SHUT_WR);
}

void TcpLink::send(const Payload& payload) {
    if (!is_open() || deaf_) return;
    std::size_t begin = 0;
    do {
        const std::size_t end = std::min(payload->size(), begin + kMostFrameBytes);
        queue_.push_back({payload, begin, end});
        unsent_ += kFrameHeadBytes + (end - begin);
        begin = end;
    } while (begin < payload->size());
}

/// False if the socket accepts no more for now.
bool TcpLink::write_some(Frame& frame, std::size_t& moved) {
    const auto bytes = std::span(*frame.payload).subspan(frame.begin, frame.end - frame.begin);
    if (!frame.has_head) {
        frame.head = frame_head(sending_key_, sequence_++, bytes, frame.end < frame.payload->size());
        frame.has_head = true;
    }
    const std::size_t of_head = std::min(frame.written, kFrameHeadBytes), of_body = frame.written - of_head;
    iovec parts[2] = {{frame.head.data() + of_head, kFrameHeadBytes - of_head},
                      {const_cast<std::uint8_t*>(bytes.data()) + of_body, bytes.size() - of_body}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    const ssize_t count = ::sendmsg(socket_.fd(), &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) {
        if (would_block(errno)) return false;
        deaf_ = true;  // it may have said good-bye before, which is read first
        queue_.clear();
        unsent_ = 0;
        return false;
    }
    frame.written += static_cast<std::size_t>(count);
    moved += static_cast<std::size_t>(count);
    unsent_ -= static_cast<std::size_t>(count);
    return true;
}

bool TcpLink::write() {
    std::size_t moved = 0;
    while (!queue_.empty() && moved < kMostMoved) {
        Frame& front = queue_.front();
        if (!write_some(front, moved)) break;
        if (front.written == kFrameHeadBytes + (front.end - front.begin)) queue_.pop_front();
    }
    return moved > 0;
}

bool TcpLink::read(std::span<std::uint8_t> scratch) {
    std::size_t moved = 0;
    while (is_open() && moved < kMostMoved) {
        const ssize_t count = ::recv(socket_.fd(), scratch.data(), scratch.size(), MSG_DONTWAIT);
        if (count == 0) close(kFarewell);
        if (count < 0 && !would_block(errno)) close(errno == ECONNRESET ? kFarewell : std::strerror(errno));
        if (count <= 0) break;
        moved += static_cast<std::size_t>(count);
        try {
            reader_.feed(scratch.first(static_cast<std::size_t>(count)));
        } catch (const FormatError& error) {
            close(error.what());
        }
    }
    return moved > 0;
}

}  // namespace treefarm
