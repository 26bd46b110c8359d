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

// Handshake by which a guest and the coordinator prove to each other that they know the run's secret. Pure: bytes in,
// bytes out.
//
//   guest       := "TFJN" version:u32 protocol:u32 fingerprint:u64 run:u8[16] nonce:u8[32] proof:u8[32]
//   coordinator := "TFJN" answer:u8 (nonce:u8[32] proof:u8[32])?       only where answer = 0, welcome
//
// A proof is BLAKE2b under the secret over all bytes sent so far by both. The keys of both directions derive from both
// nonces, so a replayed handshake does not yield them; therefore a guest counts as authenticated only when its first
// frame is valid.

/// Reason for refusing a guest. The numbers are on the wire: append only.
enum class JoinRefusal : std::uint8_t {
    none = 0,
    version,   ///< of the handshake
    protocol,  ///< of the messages
    run,       ///< the ticket belongs to another run
    secret,    ///< its proof is wrong
    build,     ///< another fingerprint: its results would have other bits
    crowded,   ///< too many unauthenticated connections
};
inline constexpr JoinRefusal kLastJoinRefusal = JoinRefusal::crowded;

/// Reason of a refusal, and cure, for the user.
struct RefusalText {
    std::string what, cure;
};
RefusalText refusal_text(JoinRefusal refusal);

/// The coordinator's message that refuses a guest.
Bytes refusal_answer(JoinRefusal refusal);

/// Keys of a session, one for each direction.
struct SessionKeys {
    JoinKey to_guest{}, to_coordinator{};
};

/// Limit of bytes that a connection may send before it has authenticated itself.
inline constexpr std::size_t kMostUnprovenBytes = 4096;

/// The coordinator's end of a connection until the guest is authenticated.
class ListenerHandshake {
  public:
    /// `nonce`: random, drawn for this connection alone.
    ListenerHandshake(const JoinTicket& ticket, std::uint64_t fingerprint, const JoinKey& nonce)
        : ticket_(ticket), fingerprint_(fingerprint), nonce_(nonce) {}

    /// Takes received bytes; take_answer() returns the reply. Throws FormatError when the handshake has failed; the
    /// bytes of take_answer() must still be sent then.
    void take(std::span<const std::uint8_t> bytes);
    Bytes take_answer() { return std::move(answer_); }

    /// Whether the guest is authenticated. The session's reader then holds the first message.
    bool is_admitted() const { return reader_ && reader_->has_message(); }
    /// Whether the guest has shown that it knows the secret, though perhaps by repeating another's bytes.
    bool has_proof() const { return reader_.has_value(); }
    FrameReader take_reader();
    const JoinKey& sending_key() const { return keys_.to_guest; }

  private:
    void read_hello();
    [[noreturn]] void turn_away(JoinRefusal refusal);

    const JoinTicket ticket_;
    const std::uint64_t fingerprint_;
    const JoinKey nonce_;
    Bytes got_;  ///< bytes of the guest's hello so far
    std::size_t bytes_ = 0;
    Bytes answer_;
    SessionKeys keys_;
    std::optional<FrameReader> reader_;
};

/// The guest's end of a connection.
class GuestHandshake {
  public:
    GuestHandshake(const JoinTicket& ticket, std::uint64_t fingerprint, const JoinKey& nonce);

    /// First message of the guest.
    const Bytes& hello() const { return hello_; }

    /// Takes received bytes. Throws FormatError if the other end is no coordinator with this secret.
    void take(std::span<const std::uint8_t> bytes);

    /// Reason for which the coordinator refused this guest.
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
