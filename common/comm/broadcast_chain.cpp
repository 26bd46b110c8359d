// SPDX-License-Identifier: Apache-2.0
#include "common/comm/broadcast_chain.h"

#include <algorithm>

namespace treefarm {

namespace {

Payload as_payload(Bytes bytes) {
    return std::make_shared<const Bytes>(std::move(bytes));
}

/// Calls `send` with each piece, in order; the pieces carry `chain` as the rest of their route.
template <class Send>
void send_pieces(const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                 std::vector<std::uint32_t> chain, std::size_t chunk_bytes, const Send& send) {
    Chunk chunk{name.blob, name.job, name.epoch, bytes.size(), offset, std::move(chain), {}};
    do {  // an empty blob is one empty chunk
        const std::size_t count = std::min<std::size_t>(chunk_bytes, bytes.size() - chunk.offset);
        const auto piece = bytes.subspan(chunk.offset, count);
        chunk.bytes.assign(piece.begin(), piece.end());
        send(as_payload(encode(chunk)));
        chunk.offset += count;
    } while (chunk.offset < bytes.size());
}

}  // namespace

void send_along_chain(Channel& channel, const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                      std::span<const std::uint32_t> chain, std::size_t chunk_bytes) {
    if (chain.empty() || offset > bytes.size()) return;
    send_pieces(name, bytes, offset, {chain.begin() + 1, chain.end()}, chunk_bytes,
                [&](const Payload& piece) { channel.send(static_cast<int>(chain.front()), piece); });
}

void send_to_each(Channel& channel, const BlobName& name, std::span<const std::uint8_t> bytes, std::uint64_t offset,
                  std::span<const std::uint32_t> peers, std::size_t chunk_bytes) {
    if (peers.empty() || offset > bytes.size()) return;
    send_pieces(name, bytes, offset, {}, chunk_bytes, [&](const Payload& piece) {
        for (const std::uint32_t peer : peers)
            channel.send(static_cast<int>(peer), piece);
    });
}

void ChainReceiver::begin_job(std::uint32_t job) {
    job_ = job;
    assemblies_.clear();
    latest_collected_.clear();
    mistrusted_.clear();
}

void ChainReceiver::pass_on(const Chunk& chunk) {
    if (chunk.chain.empty()) return;
    const std::uint32_t next = chunk.chain.front();
    const auto peers = static_cast<std::uint32_t>(channel_.peer_count());
    if (next == 0 || next >= peers || next == static_cast<std::uint32_t>(channel_.self()) ||
        chunk.chain.size() >= peers)
        return;  // a chain that the coordinator did not make; receivers that lack the piece ask for it
    Chunk onward = chunk;
    onward.chain.erase(onward.chain.begin());
    channel_.send(static_cast<int>(next), as_payload(encode(onward)));
}

bool ChainReceiver::has_capacity_for(const BlobName& name, std::size_t bytes) const {
    // A piece may arrive before its announcement. More than a few such pieces are not from the coordinator.
    constexpr std::size_t kMostNames = 8, kMostBytes = std::size_t{16} << 20;
    std::size_t names = 1;
    for (const auto& [other, assembly] : assemblies_) {
        if (assembly.announced) {
            if (other == name) return true;
            continue;
        }
        bytes += assembly.bytes.size();
        names += other != name;
    }
    return names <= kMostNames && bytes <= kMostBytes;
}

std::optional<BlobName> ChainReceiver::take(const Chunk& chunk, double now, int from) {
    pass_on(chunk);
    if (chunk.job != job_) return std::nullopt;
    const BlobName name{chunk.blob, chunk.job, chunk.epoch};
    if (from != 0 && mistrusted_.contains(name)) return std::nullopt;
    const auto latest = latest_collected_.find(name.blob);
    if (latest != latest_collected_.end() && name.epoch <= latest->second) return std::nullopt;
    if (!has_capacity_for(name, chunk.bytes.size())) return std::nullopt;

    Assembly& assembly = assemblies_[name];
    if (assembly.total && *assembly.total != chunk.total) return std::nullopt;
    if (!assembly.total) assembly.last_heard = now;
    assembly.total = chunk.total;
    if (chunk.offset > assembly.bytes.size()) {
        if (!assembly.asked) ask(name, assembly, now);
        return std::nullopt;
    }
    if (chunk.offset < assembly.bytes.size()) return std::nullopt;  // a duplicate
    assembly.asked = false;
    assembly.last_heard = now;  // not for duplicates: those must not delay a request for the rest
    assembly.bytes.insert(assembly.bytes.end(), chunk.bytes.begin(), chunk.bytes.end());
    return assembly.complete() ? std::optional(name) : std::nullopt;
}

void ChainReceiver::expect(const BlobName& name, std::uint64_t total, double now) {
    Assembly& assembly = assemblies_[name];
    if (assembly.total && *assembly.total != total)
        assembly = {};  // pieces before the announcement were of another blob
    if (!assembly.total) assembly.last_heard = now;
    assembly.total = total;
    assembly.announced = true;
}

bool ChainReceiver::mistrust(const BlobName& name, std::uint64_t total, double now) {
    if (!mistrusted_.insert(name).second) return false;
    latest_collected_.erase(name.blob);
    expect(name, total, now);
    ask(name, assemblies_[name], now);
    return true;
}

std::optional<Bytes> ChainReceiver::collect(const BlobName& name) {
    const auto found = assemblies_.find(name);
    if (found == assemblies_.end() || !found->second.complete()) return std::nullopt;
    Bytes bytes = std::move(found->second.bytes);
    latest_collected_[name.blob] = name.epoch;
    std::erase_if(assemblies_,
                  [&](const auto& entry) { return entry.first.blob == name.blob && entry.first.epoch <= name.epoch; });
    return bytes;
}

void ChainReceiver::restart(Blob blob) {
    latest_collected_.erase(blob);
    std::erase_if(assemblies_, [&](const auto& entry) { return entry.first.blob == blob; });
}

void ChainReceiver::complain(double now, double patience) {
    for (auto& [name, assembly] : assemblies_)
        if (!assembly.complete() && now - assembly.last_heard > patience) ask(name, assembly, now);
}

void ChainReceiver::ask(const BlobName& name, Assembly& assembly, double now) {
    assembly.asked = true;
    assembly.last_heard = now;
    channel_.send(0, as_payload(encode(Resend{name.blob, name.job, name.epoch, assembly.bytes.size()})));
}

}  // namespace treefarm
