// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/base/bytes.h"

namespace treefarm {

/// Version of the protocol, raised whenever a message changes its form; peers of another version are refused.
inline constexpr std::uint32_t kProtocolVersion = 17;

/// Kind of a message. The numbers are on the wire: append only (docs/design/protocol.md).
enum class Kind : std::uint8_t {
    hello = 1,   ///< worker: introduces itself
    welcome,     ///< coordinator: peer number and job
    refuse,      ///< coordinator: worker not accepted, with the reason
    chunk,       ///< a piece of the scene or of a tree, with the rest of its chain
    resend,      ///< worker: a piece is missing
    pass_begin,  ///< coordinator: the next pass and the tree that guides it
    want,        ///< worker: asks for more units
    work,        ///< coordinator: units to trace
    result,      ///< worker: pixels and evidence of finished units
    heartbeat,   ///< both: still alive
    failure,     ///< worker: cannot continue, with the reason
    rejoin,      ///< coordinator: the worker was considered lost and must start anew
    quit,        ///< coordinator: stop tracing
    bye,         ///< worker: stopped
    leave,       ///< coordinator: end the process
    drop,        ///< coordinator: units that other workers have finished
};
inline constexpr Kind kLastKind = Kind::drop;

/// Bytes before the payload: magic[4] version:u32 checksum:u64 length:u64 kind:u8; the checksum (XXH3-64) covers the
/// length and all that follows.
inline constexpr std::size_t kEnvelopeBytes = 25;

/// Builds a message in place: the payload is written to body(), then seal() completes it.
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
    std::span<const std::uint8_t> payload;  ///< inside the bytes passed to open_envelope()
};

/// Checks magic, version, length, kind and checksum; FormatError names the one that is wrong.
Envelope open_envelope(std::span<const std::uint8_t> message);

}  // namespace treefarm
