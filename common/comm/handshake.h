// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/base/bytes.h"
#include "common/comm/frames.h"
#include "common/comm/join_ticket.h"

namespace treefarm {

// How a guest and the coordinator find out that both have the run's secret. No sockets here: bytes in, bytes out.
//
//   guest       := "TFJN" version:u32 protocol:u32 fingerprint:u64 run:u8[16] nonce:u8[32] proof:u8[32]
//   coordinator := "TFJN" answer:u8 (nonce:u8[32] proof:u8[32])?       only where answer = 0, welcome
//
// A proof is BLAKE2b under the secret, of all that both have said so far. From both nonces follows a key for each
// direction; who only repeats what somebody else said does not have it, so a guest is one when its first frame holds.

/// Reason for which a guest is turned away. The numbers are on the wire: append only.
enum class JoinRefusal : std::uint8_t {
    none = 0,
    version,   ///< of the handshake
    protocol,  ///< of the messages
    run,       ///< the ticket is of another run
    secret,    ///< it proves nothing
    build,     ///< another fingerprint: it would not render the same bits
    crowded,   ///< too many are at the door
};
inline constexpr JoinRefusal kLastJoinRefusal = JoinRefusal::crowded;

/// Reason and cure, for whoever is turned away.
struct RefusalText {
    std::string what, cure;
};
RefusalText refusal_text(JoinRefusal refusal);

/// Coordinator's words to a guest that it turns away.
Bytes refusal_answer(JoinRefusal refusal);

/// Keys of a session, one for each direction.
struct SessionKeys {
    JoinKey to_guest{}, to_coordinator{};
};

/// Bytes that a connection may send before it has proved anything.
inline constexpr std::size_t kMostUnprovenBytes = 4096;

/// Coordinator's end of a connection until the guest is one.
class ListenerHandshake {
  public:
    /// `nonce`: drawn for this connection alone.
    ListenerHandshake(const JoinTicket& ticket, std::uint64_t fingerprint, const JoinKey& nonce)
        : ticket_(ticket), fingerprint_(fingerprint), nonce_(nonce) {}

    /// Takes what arrived and returns what to answer. Throws FormatError when it is over; what take_answer() returns is
    /// still to be sent then.
    void take(std::span<const std::uint8_t> bytes);
    Bytes take_answer() { return std::move(answer_); }

    /// Reader and sending key of the session, once the guest has proved itself. The reader holds the first message.
    bool is_admitted() const { return reader_ && reader_->has_message(); }
    FrameReader take_reader();
    const JoinKey& sending_key() const { return keys_.to_guest; }

  private:
    void read_hello();
    [[noreturn]] void turn_away(JoinRefusal refusal);

    const JoinTicket ticket_;
    const std::uint64_t fingerprint_;
    const JoinKey nonce_;
    Bytes got_;  ///< of the guest's first words
    std::size_t bytes_ = 0;
    Bytes answer_;
    SessionKeys keys_;
    std::optional<FrameReader> reader_;
};

/// Guest's end.
class GuestHandshake {
  public:
    GuestHandshake(const JoinTicket& ticket, std::uint64_t fingerprint, const JoinKey& nonce);

    /// First words.
    const Bytes& hello() const { return hello_; }

    /// Takes what arrived. Throws FormatError where the other end is no coordinator with this secret.
    void take(std::span<const std::uint8_t> bytes);

    /// Reason for which the coordinator turned this guest away.
    JoinRefusal refusal() const { return refusal_; }
    bool is_welcome() const { return reader_.has_value(); }
    FrameReader take_reader() { return std::move(*reader_); }
    const JoinKey& sending_key() const { return keys_.to_coordinator; }

  private:
    const JoinKey secret_;
    Bytes hello_, got_;
    JoinRefusal refusal_ = JoinRefusal::none;
    SessionKeys keys_;
    std::optional<FrameReader> reader_;
};

}  // namespace treefarm
