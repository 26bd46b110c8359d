// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>

#include "common/comm/channel.h"
#include "common/protocol/messages.h"

namespace treefarm {

/// Bytes of a piece of a broadcast. Large data go along a chain of workers: the coordinator sends each piece once, and
/// every worker passes it on while the next one is under way. If bandwidth is the limit, this costs about one transfer
/// for any number of workers; a star costs one per worker.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Identity of a blob: its kind, and its job and pass.
struct BlobName {
    Blob blob = Blob::scene;
    std::uint32_t job = 0;
    std::uint32_t epoch = 0;
    auto operator<=>(const BlobName&) const = default;  // NOLINT(modernize-use-nullptr): its own 0
};

/// Sends `bytes` from `offset` on along `chain`, a list of peer numbers; an empty chain sends nothing.
void send_along_chain(Channel& channel, const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                      std::span<const std::uint32_t> chain, std::size_t chunk_bytes = kChunkBytes);

/// Sends the pieces to each of `peers` directly; each piece is encoded once for all.
void send_to_each(Channel& channel, const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                  std::span<const std::uint32_t> peers, std::size_t chunk_bytes = kChunkBytes);

/// Receiver of broadcasts in a worker: forwards pieces and assembles its own copy. If pieces are missing, it asks the
/// coordinator for the rest: at once when a later piece shows the gap, or after a silence (see complain()).
class ChainReceiver {
  public:
    explicit ChainReceiver(Channel& channel) : channel_(channel) {}

    /// Begins a job: only its pieces are kept from now on; late pieces of other jobs are only forwarded.
    void begin_job(std::uint32_t job);

    /// Takes a piece from peer `from` at time `now` (seconds of any clock). Returns the blob's name if it is complete
    /// now. A piece that contradicts the coordinator's announcement is dropped, since any peer can send one.
    std::optional<BlobName> take(const Chunk& chunk, double now, int from = 0);

    /// Registers the coordinator's announcement of a blob, so that silence is noticed even if no piece arrives.
    void expect(const BlobName& name, std::uint64_t total, double now);

    /// Asks the coordinator to resend a blob that turned out to be wrong; from now on only pieces from the coordinator
    /// itself count for it. False if all pieces had come from the coordinator already.
    bool mistrust(const BlobName& name, std::uint64_t total, double now);

    /// Moves a complete blob out, once, and drops older ones of its kind; empty if it is incomplete.
    std::optional<Bytes> collect(const BlobName& name);

    /// Accepts blobs of this kind again, including those that were collected.
    void restart(Blob blob);

    /// Repeats requests for blobs without news for `patience` seconds.
    void complain(double now, double patience);

  private:
    struct Assembly {
        std::optional<std::uint64_t> total;
        Bytes bytes;  ///< grows with received data: a claimed length allocates nothing
        double last_heard = 0;
        bool asked = false;      ///< a resend is under way
        bool announced = false;  ///< `total` comes from the coordinator
        bool complete() const { return total && bytes.size() == *total; }
    };
    void pass_on(const Chunk& chunk);
    bool has_capacity_for(const BlobName& name, std::size_t bytes) const;
    void ask(const BlobName& name, Assembly& assembly, double now);

    Channel& channel_;
    std::map<BlobName, Assembly> assemblies_;
    std::uint32_t job_ = 0;
    std::map<Blob, std::uint32_t> latest_collected_;  ///< epochs; late pieces of these are forwarded, not kept
    std::set<BlobName> mistrusted_;                   ///< blobs for which only pieces from the coordinator itself count
};

}  // namespace treefarm
