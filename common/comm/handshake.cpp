// SPDX-License-Identifier: Apache-2.0
#include "common/comm/handshake.h"

#include <sodium.h>

#include <algorithm>

#include "common/comm/keyed_hash.h"
#include "common/protocol/envelope.h"

namespace treefarm {

namespace {

constexpr std::uint32_t kMagic = 0x4e4a4654;  // "TFJN"
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kBeginBytes = 8;  ///< magic and version
constexpr std::size_t kHelloBytes = 4 + 4 + 4 + 8 + sizeof(JoinRun) + 2 * sizeof(JoinKey);
constexpr std::size_t kRefusalBytes = 5;
constexpr std::size_t kAnswerBytes = kRefusalBytes + 2 * sizeof(JoinKey);

JoinKey keyed(const JoinKey& secret, const std::string& purpose, std::span<const std::uint8_t> bytes) {
    return keyed_hash(secret, "join: " + purpose, bytes);
}

bool equal(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
    return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

/// The guest's hello followed by the coordinator's answer up to its proof.
Bytes both(std::span<const std::uint8_t> hello, std::span<const std::uint8_t> answer) {
    Bytes bytes(hello.begin(), hello.end());
    bytes.insert(bytes.end(), answer.begin(), answer.end());
    return bytes;
}

SessionKeys session_keys(const JoinKey& secret, const Bytes& said) {
    return {keyed(secret, "key to the guest", said), keyed(secret, "key to the coordinator", said)};
}

}  // namespace

RefusalText refusal_text(JoinRefusal refusal) {
    switch (refusal) {
        case JoinRefusal::version:
        case JoinRefusal::protocol:
            return {"the render runs another version of treefarm, with another handshake",
                    "start the same build everywhere; treefarm --version tells them apart"};
        case JoinRefusal::run:
            return {"another run uses this address: the one of this ticket is over, or was started again",
                    "take the file join from the run directory again"};
        case JoinRefusal::secret:
            return {"the secret of this ticket is not the run's", "take the file join of its run directory"};
        case JoinRefusal::build:
            return {"the render runs another build of treefarm, or its processor rounds differently",
                    "start the same build everywhere; treefarm --version tells them apart"};
        case JoinRefusal::crowded:
            return {"too many workers are joining at this moment", "try again in some seconds"};
        case JoinRefusal::none:
            break;
    }
    return {"the coordinator refused it", "treefarm --version tells builds apart"};
}

Bytes refusal_answer(JoinRefusal refusal) {
    ByteWriter writer;
    writer.put(kMagic);
    writer.put(static_cast<std::uint8_t>(refusal));
    return writer.take();
}

void ListenerHandshake::take(std::span<const std::uint8_t> bytes) {
    bytes_ += bytes.size();
    if (bytes_ > kMostUnprovenBytes) throw FormatError("it sent too many bytes without a proof");
    if (!reader_) {
        const std::size_t count = std::min(bytes.size(), kHelloBytes - got_.size());
        got_.insert(got_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
        bytes = bytes.subspan(count);
        read_hello();
        if (!reader_) return;
    }
    reader_->feed(bytes);
}

/// Reads as many fields as have arrived, so that a foreign protocol is recognised by its first bytes.
void ListenerHandshake::read_hello() {
    if (got_.size() < kBeginBytes) return;
    ByteReader reader(got_);
    if (reader.get<std::uint32_t>() != kMagic) throw FormatError("it is not treefarm");
    if (reader.get<std::uint32_t>() != kVersion) turn_away(JoinRefusal::version);
    if (got_.size() < kHelloBytes) return;
    if (reader.get<std::uint32_t>() != kProtocolVersion) turn_away(JoinRefusal::protocol);
    const auto fingerprint = reader.get<std::uint64_t>();
    if (!equal(reader.get_bytes(sizeof(JoinRun)), ticket_.run)) turn_away(JoinRefusal::run);
    reader.get_bytes(sizeof(JoinKey));
    const auto said = std::span(got_).first(kHelloBytes - sizeof(JoinKey));
    if (!equal(reader.get_bytes(sizeof(JoinKey)), keyed(ticket_.secret, "guest", said))) turn_away(JoinRefusal::secret);
    if (fingerprint != fingerprint_) turn_away(JoinRefusal::build);

    Bytes answer = refusal_answer(JoinRefusal::none);
    answer.insert(answer.end(), nonce_.begin(), nonce_.end());
    const Bytes words = both(got_, answer);
    const JoinKey proof = keyed(ticket_.secret, "coordinator", words);
    answer.insert(answer.end(), proof.begin(), proof.end());
    answer_ = std::move(answer);
    keys_ = session_keys(ticket_.secret, words);
    reader_.emplace(keys_.to_coordinator, kMostUnprovenBytes);
}

void ListenerHandshake::turn_away(JoinRefusal refusal) {
    answer_ = refusal_answer(refusal);
    throw FormatError(refusal_text(refusal).what);
}

FrameReader ListenerHandshake::take_reader() {
    reader_->allow(kMostFrameBytes);
    return std::move(*reader_);
}

GuestHandshake::GuestHandshake(const JoinTicket& ticket, std::uint64_t fingerprint, const JoinKey& nonce)
    : secret_(ticket.secret) {
    ByteWriter writer;
    writer.put(kMagic);
    writer.put(kVersion);
    writer.put(kProtocolVersion);
    writer.put(fingerprint);
    writer.put_bytes(ticket.run);
    writer.put_bytes(nonce);
    hello_ = writer.take();
    const JoinKey proof = keyed(ticket.secret, "guest", hello_);
    hello_.insert(hello_.end(), proof.begin(), proof.end());
}

void GuestHandshake::take(std::span<const std::uint8_t> bytes) {
    if (!reader_) {
        const std::size_t count = std::min(bytes.size(), kAnswerBytes - got_.size());
        got_.insert(got_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
        bytes = bytes.subspan(count);
        if (got_.size() < kRefusalBytes) return;
        ByteReader reader(got_);
        if (reader.get<std::uint32_t>() != kMagic) throw FormatError("the program at this address is not treefarm");
        const auto answer = reader.get<std::uint8_t>();
        if (answer > static_cast<std::uint8_t>(kLastJoinRefusal))
            throw FormatError("the program at this address is another version of treefarm");
        refusal_ = static_cast<JoinRefusal>(answer);
        if (refusal_ != JoinRefusal::none || got_.size() < kAnswerBytes) return;
        reader.get_bytes(sizeof(JoinKey));
        const Bytes words = both(hello_, std::span(got_).first(kAnswerBytes - sizeof(JoinKey)));
        if (!equal(reader.get_bytes(sizeof(JoinKey)), keyed(secret_, "coordinator", words)))
            throw FormatError("the program at this address does not know the run's secret");
        keys_ = session_keys(secret_, words);
        reader_.emplace(keys_.to_guest, kMostFrameBytes);
    }
    reader_->feed(bytes);
}

}  // namespace treefarm
