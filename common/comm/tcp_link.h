// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>

#include "common/comm/channel.h"
#include "common/comm/frames.h"
#include "common/comm/tcp_socket.h"

namespace treefarm {

/// Bytes that a link reads at once.
inline constexpr std::size_t kScratchBytes = std::size_t{256} << 10;

/// One end of a session over a non-blocking socket.
class TcpLink {
  public:
    /// `reader`: of the other end's data; it may hold messages already.
    TcpLink(Socket socket, const JoinKey& sending_key, FrameReader reader);

    /// Queues a message.
    void send(const Payload& payload);

    /// Move data without waiting, up to a limit; false if nothing could be moved.
    bool write();
    bool read(std::span<std::uint8_t> scratch);

    /// The next whole message, or nothing.
    std::optional<Bytes> take() { return reader_.next(); }
    bool has_message() const { return reader_.has_message(); }

    /// Whether more messages may arrive.
    bool is_open() const { return closed_.empty(); }
    /// Reason for the end; kFarewell if the other end closed the connection.
    const std::string& why_closed() const { return closed_; }
    void close(const std::string& why);
    /// Announces the end of this direction; the queue must be empty.
    void end_sending();

    int fd() const { return socket_.fd(); }
    /// Queued bytes.
    std::size_t unsent() const { return unsent_; }

    static constexpr const char* kFarewell = "closed its connection";

  private:
    struct Frame {
        Payload payload;
        std::size_t begin, end;   ///< of the part
        FrameHead head{};         ///< computed just before sending: MACs of everything at once would take too long
        std::size_t written = 0;  ///< head included
        bool has_head = false;
    };

    bool write_some(Frame& frame, std::size_t& moved);

    Socket socket_;
    JoinKey sending_key_;
    FrameReader reader_;
    std::uint64_t sequence_ = 0;
    std::deque<Frame> queue_;
    std::size_t unsent_ = 0;
    std::string closed_;
    bool deaf_ = false;  ///< the other end accepts no more data; data it has sent may still arrive
};

}  // namespace treefarm
