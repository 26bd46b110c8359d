// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "common/comm/handshake.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/join_keys.h"

// What a stranger may send to the coordinator's door, and whoever answers to a guest: first words, answers and frames,
// cut anywhere. Nobody is let in who does not have the secret, whatever is said.

using namespace treefarm;
using test::key_of;

namespace {

constexpr std::uint64_t kBuild = 7;

JoinTicket ticket() {
    return {{1, 2, 3}, "localhost", 1, key_of(3)};
}

/// Feeds `bytes` in pieces whose lengths the first byte says; FormatError ends it.
template <class Take>
void feed(std::span<const std::uint8_t> bytes, const Take& take) {
    const std::size_t piece = bytes.empty() ? 1 : 1 + bytes[0];
    bytes = bytes.subspan(std::min<std::size_t>(1, bytes.size()));
    try {
        while (!bytes.empty()) {
            const std::size_t count = std::min(piece, bytes.size());
            take(bytes.first(count));
            bytes = bytes.subspan(count);
        }
    } catch (const FormatError&) {
    }
}

Bytes framed(const JoinKey& key, std::uint64_t sequence, std::span<const std::uint8_t> bytes, bool more) {
    const FrameHead head = frame_head(key, sequence, bytes, more);
    ByteWriter all;
    all.reserve(head.size() + bytes.size());
    all.put_bytes(head);
    all.put_bytes(bytes);
    return all.take();
}

/// Who repeats what an honest guest said gets no farther: the nonce is another.
void knock(std::span<const std::uint8_t> bytes) {
    ListenerHandshake listener(ticket(), kBuild, key_of(5));
    feed(bytes, [&](std::span<const std::uint8_t> piece) { listener.take(piece); });
    if (listener.is_admitted()) std::abort();
}

void answer(std::span<const std::uint8_t> bytes) {
    GuestHandshake guest(ticket(), kBuild, key_of(6));
    feed(bytes, [&](std::span<const std::uint8_t> piece) {
        if (guest.refusal() == JoinRefusal::none) guest.take(piece);
    });
    if (guest.is_welcome() && guest.take_reader().has_message()) std::abort();
}

/// Frames whose MACs are right: the first byte of each says how long it is, and whether more parts follow.
void frames(std::span<const std::uint8_t> bytes) {
    Bytes stream, said;
    for (std::uint64_t sequence = 0; !bytes.empty(); ++sequence) {
        const std::size_t count = std::min<std::size_t>(bytes[0] / 2, bytes.size() - 1);
        const bool more = bytes[0] % 2 != 0;
        const Bytes frame = framed(key_of(1), sequence, bytes.subspan(1, count), more);
        stream.insert(stream.end(), frame.begin(), frame.end());
        if (more && count == 0) break;  // refused, and the rest is not heard
        said.insert(said.end(), bytes.begin() + 1, bytes.begin() + 1 + static_cast<std::ptrdiff_t>(count));
        bytes = bytes.subspan(1 + count);
    }
    FrameReader reader(key_of(1), 1 << 16);
    Bytes heard;
    try {
        for (std::size_t at = 0; at < stream.size(); at += 7)
            reader.feed(std::span(stream).subspan(at, std::min<std::size_t>(7, stream.size() - at)));
    } catch (const FormatError&) {
    }
    while (auto message = reader.next())
        heard.insert(heard.end(), message->begin(), message->end());
    // A last message may have lacked its end.
    if (heard.size() > said.size() || !std::equal(heard.begin(), heard.end(), said.begin())) std::abort();
}

void ticket_file(std::span<const std::uint8_t> bytes) {
    try {
        const JoinTicket read = parse_ticket({bytes.begin(), bytes.end()}, "join");
        if (parse_ticket(ticket_text(read), "join") != read) std::abort();
    } catch (const InputError&) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::uint8_t> rest(data + 1, size - 1);
    switch (data[0] % 4) {
        case 0:
            knock(rest);
            break;
        case 1:
            answer(rest);
            break;
        case 2:
            frames(rest);
            break;
        default:
            ticket_file(rest);
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    GuestHandshake guest(ticket(), kBuild, key_of(6));
    ListenerHandshake other(ticket(), kBuild, key_of(4));  // not the nonce of the one that is fuzzed
    const Bytes& hello = guest.hello();
    other.take(hello);
    const Bytes answer = other.take_answer();
    guest.take(answer);
    const Bytes frame = framed(guest.sending_key(), 0, hello, false);
    const std::string hello_text(hello.begin(), hello.end()), frame_text(frame.begin(), frame.end()),
        answer_text(answer.begin(), answer.end());
    return {std::string("\0\xff", 2) + hello_text,
            std::string("\0\x10", 2) + hello_text + frame_text,
            "\1\xff" + answer_text,
            std::string("\1\3", 2) + answer_text + frame_text,
            std::string("\2\x0b") + "hello" + "\x08" + "more" + std::string(1, '\0') + "\x01",
            "\3" + ticket_text(ticket())};
}
