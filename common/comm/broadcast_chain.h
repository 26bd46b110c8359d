// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>

#include "common/comm/channel.h"
#include "common/protocol/messages.h"

namespace treefarm {

/// Large things go along a chain of workers in pieces: the coordinator sends each piece once, every worker passes it on
/// while the next one is under way. On a network where bandwidth is the limit this costs about one transfer, however
/// many workers there are; a star costs one per worker.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Name of a blob: which one, of which job and pass.
struct BlobName {
    Blob blob = Blob::scene;
    std::uint32_t job = 0;
    std::uint32_t epoch = 0;
    auto operator<=>(const BlobName&) const = default;  // NOLINT(modernize-use-nullptr): its own 0
};

/// The coordinator's end. Sends `bytes` from `offset` on along `chain` (peer numbers; none: sends nothing).
void send_along_chain(Channel& channel, const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                      std::span<const std::uint32_t> chain, std::size_t chunk_bytes = kChunkBytes);

/// Sends them to each of `peers` directly, every piece made once for all.
void send_to_each(Channel& channel, const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                  std::span<const std::uint32_t> peers, std::size_t chunk_bytes = kChunkBytes);

/// A worker's end: forwards what it receives and assembles its own copy. A blob with a hole asks the coordinator for
/// the rest, at once when a later piece shows the hole, or after a silence (see complain()).
class ChainReceiver {
  public:
    explicit ChainReceiver(Channel& channel) : channel_(channel) {}

    /// From now on only pieces of this job are kept; those of others, still on their way, are passed on.
    void begin_job(std::uint32_t job);

    /// Takes a piece that peer `from` passed on, at time `now` (seconds of any clock); returns the blob's name when
    /// that completed it. A piece that does not fit what the coordinator announced is dropped: any peer can send one.
    std::optional<BlobName> take(const Chunk& chunk, double now, int from = 0);

    /// The coordinator's word that this blob is on its way: silence is noticed even if no piece ever comes.
    void expect(const BlobName& name, std::uint64_t total, double now);

    /// Asks the coordinator for a blob that was handed out and turned out to be wrong; from now on only the
    /// coordinator's own pieces of it count. False if it was wrong although they all came from there.
    bool mistrust(const BlobName& name, std::uint64_t total, double now);

    /// Hands out a complete blob, once, and forgets older ones of its kind; nothing if it is not complete.
    std::optional<Bytes> collect(const BlobName& name);

    /// Takes blobs of this kind anew, even those that were handed out.
    void restart(Blob blob);

    /// Asks again for blobs of which nothing was heard for `patience` seconds.
    void complain(double now, double patience);

  private:
    struct Assembly {
        std::optional<std::uint64_t> total;
        Bytes bytes;  ///< grows with what arrives: a length is never trusted with memory
        double last_heard = 0;
        bool asked = false;      ///< a resend is under way
        bool announced = false;  ///< `total` is the coordinator's word
        bool complete() const { return total && bytes.size() == *total; }
    };
    void pass_on(const Chunk& chunk);
    bool has_capacity_for(const BlobName& name, std::size_t bytes) const;
    void ask(const BlobName& name, Assembly& assembly, double now);

    Channel& channel_;
    std::map<BlobName, Assembly> assemblies_;
    std::uint32_t job_ = 0;
    std::map<Blob, std::uint32_t> latest_collected_;  ///< epochs; late pieces of these are passed on, not kept
    std::set<BlobName> mistrusted_;                   ///< only the coordinator's own pieces of these count
};

}  // namespace treefarm
