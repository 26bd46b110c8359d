// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "common/protocol/messages.h"
#include "tests/fuzz/fuzz.h"

using namespace treefarm;

namespace {

Bytes encode_any(const Message& message) {
    return std::visit([](const auto& m) { return encode(m); }, message);
}

void read(std::span<const std::uint8_t> bytes) {
    try {
        // One message has one byte form.
        if (encode_any(decode(bytes)) != Bytes(bytes.begin(), bytes.end())) std::abort();
    } catch (const FormatError&) {
    }
}

/// The envelope around a payload, sum and length right, so that mutations get past them.
Bytes sealed(std::uint8_t kind, std::span<const std::uint8_t> payload) {
    EnvelopeWriter writer(static_cast<Kind>(kind));
    for (const std::uint8_t byte : payload)
        writer.body().put(byte);
    return writer.seal();
}

}  // namespace

/// The first byte is the kind of a message whose payload follows, or 0: a whole message follows.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::uint8_t> rest(data + 1, size - 1);
    if (data[0] == 0)
        read(rest);
    else
        read(sealed(data[0], rest));
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    Result result;
    result.pass = 3;
    result.evidence = {1, 2, 3};
    result.stats.first_invalid.push_back({3, 1, 2, 5, {0, 1, 2}});
    result.stats.tails.add({2.5f, 3, 1, 0, 5, {LightFound::sampled, PathClass::mirror, 4}});
    result.units.push_back({{3, 0, 0, 2, 1, 0}, std::vector<PixelEstimate>(2), {}});
    PassBegin begin;
    begin.plan.spp = 4;
    begin.plan.chunks = begin.plan.blocks_per_unit = 1;
    const std::vector<Message> messages = {Hello{1, 2, 3, 4, 5, 6, "host", "0.1"},
                                           Welcome{4, 0.5, "[budget]\nspp = 4\n", 5, 77, true},
                                           Refuse{"fingerprints differ"},
                                           Chunk{Blob::tree, 1, 5, 100, 10, {2, 3}, {9, 8, 7}},
                                           Resend{Blob::scene, 1, 0, 42},
                                           begin,
                                           Want{1, 2, 30},
                                           Work{2, {{2, 0, 0, 8, 8, 0}, {2, 8, 0, 16, 8, 1}}},
                                           result,
                                           Heartbeat{1, 2, 3},
                                           Failure{1, "no memory"},
                                           Rejoin{3},
                                           Bye{5},
                                           Leave{true},
                                           Drop{2, {{2, 0, 0, 8, 8, 0}}}};
    std::vector<std::string> seeds;
    for (const Message& message : messages) {
        const Bytes bytes = encode_any(message);
        seeds.push_back(std::string(1, static_cast<char>(message.index() + 1)) +
                        std::string(bytes.begin() + kEnvelopeBytes, bytes.end()));
    }
    const Bytes whole = encode_any(messages[0]);
    seeds.push_back(std::string(1, '\0') + std::string(whole.begin(), whole.end()));
    return seeds;
}
