// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/base/bytes.h"

namespace treefarm {

/// Encoded message: immutable and shared, so that one tree can be sent to many peers without copies.
using Payload = std::shared_ptr<const Bytes>;

struct Received {
    int peer = 0;
    Bytes bytes;
};

/// Limit of a message; longer ones are refused and allocate nothing. Messages of workers are far shorter
/// (worker_loop.cpp).
inline constexpr std::size_t kLongestMessage = std::size_t{1} << 30;

struct JoinTicket;
struct GuestOptions;

/// Point-to-point messages between the coordinator (peer 0) and the workers (1, 2, ...). No call blocks on a peer: a
/// dead peer costs memory, never progress. Messages between two peers arrive whole and in order, or not at all. Not
/// thread-safe: one thread of a process communicates (MPI_THREAD_FUNNELED).
class Channel {
  public:
    virtual ~Channel() = default;
    virtual int self() const = 0;
    /// Number of processes, including the coordinator and peers that have left.
    virtual int peer_count() const = 0;
    /// Numbers of the other peers that can be sent to. Numbers are never reused.
    virtual std::vector<int> peers() const;
    /// Whether messages from a peer can arrive. MPI does not report deaths: its peers stay open.
    virtual bool is_open(int) const { return true; }
    /// Whether a peer is a guest: a worker that joined over a connection of its own. Only the coordinator can send to
    /// it, and nothing waits for it.
    virtual bool is_guest(int) const { return false; }
    /// Bytes queued for a guest.
    virtual std::size_t unsent(int) const { return 0; }
    /// Starts to accept guests, and returns the ticket that they need. Throws InputError if that is impossible.
    virtual const JoinTicket& take_guests(const GuestOptions& options);
    /// Whether guests are accepted.
    virtual bool takes_guests() const { return false; }
    /// Starts to send and returns at once. The payload lives until it is sent.
    virtual void send(int peer, Payload payload) = 0;
    /// Advances transfers. Returns a message that has arrived, if any.
    virtual std::optional<Received> poll() = 0;
    /// Whether all messages passed to send() have left.
    virtual bool drained() = 0;
    /// Sleeps until a message may have arrived, at most `seconds`.
    virtual void rest(double seconds) = 0;
    /// Bytes passed to send() and returned by poll() so far.
    virtual std::uint64_t bytes_sent() const = 0;
    virtual std::uint64_t bytes_received() const = 0;
};

}  // namespace treefarm
