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

// Messages on a stream of bytes between two that share a key, one for each direction:
//
//   frame := length:u32 mac:u8[16] bytes       the top bit of length: more parts of this message follow
//
// The MAC is Poly1305 over length and bytes; its one-time key is the first 32 bytes of ChaCha20 under the direction's
// key, with the frame's number as nonce. Frames count from 0, so one that is repeated, left out, swapped or foreign
// fails.

/// Bytes of a frame at most: a longer message goes in parts.
inline constexpr std::size_t kMostFrameBytes = std::size_t{64} << 20;

inline constexpr std::size_t kFrameHeadBytes = 20;
using FrameHead = std::array<std::uint8_t, kFrameHeadBytes>;

/// What goes before the bytes of frame number `sequence`.
FrameHead frame_head(const JoinKey& key, std::uint64_t sequence, std::span<const std::uint8_t> bytes, bool more);

/// Whether a head is that of a message in one part. Takes as long whatever differs.
bool is_head_of(const FrameHead& head, const JoinKey& key, std::uint64_t sequence, std::span<const std::uint8_t> bytes);

/// Makes messages of what arrives, however it is cut.
class FrameReader {
  public:
    /// `most_bytes`: of a frame.
    FrameReader(const JoinKey& key, std::size_t most_bytes) : key_(key), most_bytes_(most_bytes) {}

    void allow(std::size_t most_bytes) { most_bytes_ = most_bytes; }

    /// Takes what has arrived. Throws FormatError at the first frame that is too long or has a wrong MAC; nothing of
    /// it, or of what follows, becomes a message.
    void feed(std::span<const std::uint8_t> bytes);

    /// The next whole message.
    std::optional<Bytes> next();
    bool has_message() const { return !messages_.empty(); }

  private:
    void begin_frame();
    void end_frame();

    JoinKey key_;
    std::size_t most_bytes_;
    std::uint64_t sequence_ = 0;
    FrameHead head_{};
    std::size_t head_bytes_ = 0;  ///< that are there
    std::size_t length_ = 0;
    bool more_ = false;
    Bytes body_;       ///< grows with what arrives: a length is never trusted with memory
    Bytes assembled_;  ///< earlier parts
    std::deque<Bytes> messages_;
};

}  // namespace treefarm
