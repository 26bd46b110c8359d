// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/base/bytes.h"

namespace treefarm {

/// Raised whenever a message changes its form: peers of another version are refused, not guessed at.
inline constexpr std::uint32_t kProtocolVersion = 15;

/// Kind of a message. The numbers are on the wire: append only (docs/design/protocol.md).
enum class Kind : std::uint8_t {
    hello = 1,   ///< worker: here I am
    welcome,     ///< coordinator: your number and the job
    refuse,      ///< coordinator: not with us, and why
    chunk,       ///< a piece of the scene or of a tree, with the rest of its way
    resend,      ///< worker: a piece is missing
    pass_begin,  ///< coordinator: the coming pass and the tree that guides it
    want,        ///< worker: so many more units, please
    work,        ///< coordinator: units to trace
    result,      ///< worker: pixels and tree update of finished units
    heartbeat,   ///< both: alive
    failure,     ///< worker: cannot go on, and why
    rejoin,      ///< coordinator: you were thought lost, start anew
    quit,        ///< coordinator: stop tracing
    bye,         ///< worker: stopped
    leave,       ///< coordinator: end the process
    drop,        ///< coordinator: units that others have done meanwhile
};
inline constexpr Kind kLastKind = Kind::drop;

/// magic[4] version:u32 checksum:u64 length:u64 kind:u8 payload[length]; the checksum (XXH3-64) covers all that follows
/// it.
inline constexpr std::size_t kEnvelopeBytes = 25;

/// Builds a message in place: write the payload into body(), then seal().
class EnvelopeWriter {
  public:
    explicit EnvelopeWriter(Kind kind);
    ByteWriter& body() { return writer_; }
    Bytes seal();

  private:
    ByteWriter writer_;
};

struct Envelope {
    Kind kind;
    std::span<const std::uint8_t> payload;  ///< inside the bytes that were opened
};

/// Checks magic, version, length, kind and checksum; FormatError says which one is wrong.
Envelope open_envelope(std::span<const std::uint8_t> message);

}  // namespace treefarm
