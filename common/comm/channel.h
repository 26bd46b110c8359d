// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "common/base/bytes.h"

namespace treefarm {

/// A message as it travels: immutable and shared, so that one tree can be on its way to many peers without copies.
using Payload = std::shared_ptr<const Bytes>;

struct Received {
    int peer = 0;
    Bytes bytes;
};

/// Point-to-point messages between the coordinator (peer 0) and the workers (1, 2, ...). Neither call ever blocks on a
/// peer: a dead one costs memory, never progress. Messages between two peers arrive whole and in order, or not at all.
/// Not thread-safe: one thread of a process talks (MPI_THREAD_FUNNELED).
class Channel {
  public:
    virtual ~Channel() = default;
    virtual int self() const = 0;
    /// Number of processes, the coordinator included.
    virtual int peer_count() const = 0;
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
