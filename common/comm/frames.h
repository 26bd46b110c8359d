// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "common/base/bytes.h"
#include "common/comm/join_ticket.h"

namespace treefarm {

// Messages on a byte stream between two peers that share one key per direction:
//
//   frame := length:u32 mac:u8[16] bytes    the top bit of length: more parts of this message follow
//
// The MAC is Poly1305 over length and bytes; its one-time key is the first 32 bytes of ChaCha20 under the direction's
// key, with the frame's number as nonce. Frames are numbered from 0, so a frame that is repeated, omitted, reordered or
// forged fails.

/// Greatest size of a frame in bytes; a longer message is sent in parts.
inline constexpr std::size_t kMostFrameBytes = std::size_t{64} << 20;

inline constexpr std::size_t kFrameHeadBytes = 20;
using FrameHead = std::array<std::uint8_t, kFrameHeadBytes>;

/// Head of frame number `sequence`, sent before its bytes.
FrameHead frame_head(const JoinKey& key, std::uint64_t sequence, std::span<const std::uint8_t> bytes, bool more);

/// Whether the head belongs to these bytes as a message in one part. Runs in constant time.
bool is_head_of(const FrameHead& head, const JoinKey& key, std::uint64_t sequence, std::span<const std::uint8_t> bytes);

/// Assembles messages from received bytes, however they are cut.
class FrameReader {
  public:
    /// `most_bytes`: limit of a frame.
    FrameReader(const JoinKey& key, std::size_t most_bytes) : key_(key), most_bytes_(most_bytes) {}

    void allow(std::size_t most_bytes) { most_bytes_ = most_bytes; }

    /// Takes received bytes. Throws FormatError at the first frame that is too long or has a wrong MAC; neither it nor
    /// later bytes become a message.
    void feed(std::span<const std::uint8_t> bytes);

    /// The next whole message, or nothing.
    std::optional<Bytes> next();
    bool has_message() const { return !messages_.empty(); }

  private:
    void begin_frame();
    void end_frame();

    JoinKey key_;
    std::size_t most_bytes_;
    std::uint64_t sequence_ = 0;
    FrameHead head_{};
    std::size_t head_bytes_ = 0;  ///< bytes of the head received so far
    std::size_t length_ = 0;
    bool more_ = false;
    Bytes body_;       ///< grows with received data: a claimed length allocates nothing
    Bytes assembled_;  ///< earlier parts of the message
    std::deque<Bytes> messages_;
};

}  // namespace treefarm
