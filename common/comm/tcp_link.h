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

/// One end of a session over a socket that never blocks.
class TcpLink {
  public:
    /// `reader`: of what the other end sends; it may hold messages already.
    TcpLink(Socket socket, const JoinKey& sending_key, FrameReader reader);

    /// Queues a message.
    void send(const Payload& payload);

    /// Move what can be moved without waiting, but not for ever; false if nothing could.
    bool write();
    bool read(std::span<std::uint8_t> scratch);

    /// The next whole message.
    std::optional<Bytes> take() { return reader_.next(); }
    bool has_message() const { return reader_.has_message(); }

    /// Whether more may come.
    bool is_open() const { return closed_.empty(); }
    /// Reason why not; kFarewell where the other end has closed it.
    const std::string& why_closed() const { return closed_; }
    void close(const std::string& why);
    /// Says that nothing more will come from here; what is queued must have been sent.
    void end_sending();

    int fd() const { return socket_.fd(); }
    /// Bytes that are queued.
    std::size_t unsent() const { return unsent_; }

    static constexpr const char* kFarewell = "closed its connection";

  private:
    struct Frame {
        Payload payload;
        std::size_t begin, end;   ///< of the part
        FrameHead head{};         ///< made when its turn comes: a MAC of everything at once would take too long
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
    bool deaf_ = false;  ///< the other end takes nothing more; what it has sent may still come
};

}  // namespace treefarm
