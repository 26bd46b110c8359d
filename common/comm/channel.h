// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/base/bytes.h"

namespace treefarm {

/// A message as it travels: immutable and shared, so that one tree can be on its way to many peers without copies.
using Payload = std::shared_ptr<const Bytes>;

struct Received {
    int peer = 0;
    Bytes bytes;
};

/// Longer messages are refused, and take no memory: what a worker sends is far shorter (worker_loop.cpp).
inline constexpr std::size_t kLongestMessage = std::size_t{1} << 30;

struct JoinTicket;
struct GuestOptions;

/// Point-to-point messages between the coordinator (peer 0) and the workers (1, 2, ...). Neither call ever blocks on a
/// peer: a dead one costs memory, never progress. Messages between two peers arrive whole and in order, or not at all.
/// Not thread-safe: one thread of a process talks (MPI_THREAD_FUNNELED).
class Channel {
  public:
    virtual ~Channel() = default;
    virtual int self() const = 0;
    /// Number of processes, the coordinator included; of all that there have been, where peers come and go.
    virtual int peer_count() const = 0;
    /// Peers other than this one that can be spoken to, by number. No number is ever given twice.
    virtual std::vector<int> peers() const;
    /// Whether anything can come from a peer. MPI tells of no death: its peers stay open.
    virtual bool is_open(int) const { return true; }
    /// Whether a peer came by itself, over a connection of its own: only the coordinator can speak to it, and nobody
    /// waits for it.
    virtual bool is_guest(int) const { return false; }
    /// Bytes for a guest that are still here.
    virtual std::size_t unsent(int) const { return 0; }
    /// Lets guests in from now on, and returns what they need to know. Throws InputError where that cannot be.
    virtual const JoinTicket& take_guests(const GuestOptions& options);
    /// Whether guests may come.
    virtual bool takes_guests() const { return false; }
    /// Starts sending; returns at once. The payload lives until it is sent.
    virtual void send(int peer, Payload payload) = 0;
    /// Moves transfers along; returns a message that has arrived, if any.
    virtual std::optional<Received> poll() = 0;
    /// True when nothing that was handed to send() is still on its way out.
    virtual bool drained() = 0;
    /// Gives up the processor until something may have arrived, at most `seconds`.
    virtual void rest(double seconds) = 0;
    /// Bytes handed to send() and taken in by poll() so far.
    virtual std::uint64_t bytes_sent() const = 0;
    virtual std::uint64_t bytes_received() const = 0;
};

}  // namespace treefarm
