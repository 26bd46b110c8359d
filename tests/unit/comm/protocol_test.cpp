// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/base/hash.h"
#include "common/protocol/fingerprint.h"
#include "common/protocol/messages.h"

namespace treefarm {
namespace {

Result sample_result() {
    Result result;
    result.incarnation = 77;
    result.pass = 3;
    result.evidence = {1, 2, 3};
    result.stats.paths = 24;
    result.stats.trace_seconds = 0.25;
    result.stats.busy_seconds = 0.75;
    result.stats.split_path_rays = 7;
    result.stats.first_invalid.push_back({3, 1, 2, 5, {0, 1, 2}});
    result.stats.tails.worst = {{2.5f, 3, 1, 2, 5, {LightFound::sky_met, PathClass::rough_glass, 7}},
                                {0.5f, 3, 0, 1, 6, {}}};
    for (std::uint16_t k = 0; k < 2; ++k) {
        UnitResult unit;
        unit.unit = {3, static_cast<std::uint16_t>(2 * k), 0, static_cast<std::uint16_t>(2 * k + 2), 3, k};
        for (int p = 0; p < 6; ++p) {
            PixelEstimate pixel;
            for (std::uint32_t s = 0; s < 3; ++s)
                pixel.add(s, Rgb(0.1f * static_cast<float>(p), static_cast<float>(s), static_cast<float>(k)));
            unit.pixels.push_back(pixel);
        }
        unit.aovs.values = {1.5, -2.0, k + 0.25};
        if (k == 1) unit.aovs.direct.assign(unit.pixels.rbegin(), unit.pixels.rend());
        result.units.push_back(unit);
    }
    result.units.push_back({{.pass = 3, .x1 = 2, .y1 = 2}, {}, {}});  // a tile that only splats
    result.units.push_back({{.pass = 3, .kind = UnitKind::light_paths, .first = 1ull << 40, .count = 5}, {}, {}});
    result.units.push_back({{.pass = 3, .kind = UnitKind::chains, .first = 7, .count = 1}, {}, {}});
    result.splats = {4, 5};
    return result;
}

PassBegin sample_pass() {
    PassBegin begin;
    begin.plan = {.index = 2,
                  .spp = 500,
                  .first_sample = 60,
                  .next_event = true,
                  .record = false,
                  .record_weight = 0.5,
                  .learn_mixture = true,
                  .blocks_per_unit = 2,
                  .chunks = 4,
                  .kernel = {.guided = true, .views = true},
                  .units = {.light_paths = 4, .first_light_path = 8, .chains = 3},
                  .layers = {.splats = {1200, -7}}};
    begin.tree_bytes = 1234;
    begin.tree_hash = 99;
    return begin;
}

std::vector<Message> samples() {
    return {Hello{1, 2, 3, 4, 5, 6, "host", "0.1"},
            Welcome{4, 0.5, "scene.file = 'x'", 5, 77, true},
            Refuse{"fingerprints differ"},
            Chunk{Blob::tree, 1, 5, 100, 10, {2, 3}, {9, 8, 7}},
            Resend{Blob::scene, 1, 0, 42},
            sample_pass(),
            Want{1, 2, 30, 400},
            Work{2,
                 {{2, 0, 0, 8, 8, 0},
                  {2, 8, 0, 16, 8, 1},
                  {.pass = 2, .kind = UnitKind::light_paths, .first = 1ull << 33, .count = 9},
                  {.pass = 2, .kind = UnitKind::chains, .first = 3, .count = 2}}},
            sample_result(),
            Heartbeat{1, 2, 3},
            Failure{1, "no memory"},
            Rejoin{3},
            Quit{},
            Bye{5},
            Leave{true},
            Drop{2, {{2, 0, 0, 8, 8, 0}}}};
}

Bytes encode_any(const Message& message) {
    return std::visit([](const auto& m) { return encode(m); }, message);
}

TEST(Protocol, EveryKindHasASample) {
    ASSERT_EQ(samples().size(), static_cast<std::size_t>(kLastKind));
    ASSERT_EQ(samples().size(), std::variant_size_v<Message>);
}

TEST(Protocol, EveryMessageRoundTrips) {
    for (const Message& message : samples()) {
        const Bytes bytes = encode_any(message);
        const Message back = decode(bytes);
        EXPECT_EQ(back.index(), message.index());
        EXPECT_EQ(encode_any(back), bytes) << "kind " << message.index() + 1;
    }
}

TEST(Protocol, FieldsArriveAsTheyWereSent) {
    EXPECT_EQ(std::get<Hello>(decode(encode(Hello{1, 2, 3, 4, 5, 6, "host", "0.1"}))),
              (Hello{1, 2, 3, 4, 5, 6, "host", "0.1"}));
    const auto chunk = std::get<Chunk>(samples()[3]);
    EXPECT_EQ(std::get<Chunk>(decode(encode(chunk))), chunk);
    const auto begin = std::get<PassBegin>(decode(encode(sample_pass())));
    EXPECT_EQ(begin.plan.spp, 500u);
    EXPECT_EQ(begin.plan.chunks, 4u);
    EXPECT_TRUE(begin.plan.next_event);
    EXPECT_FALSE(begin.plan.record);
    EXPECT_EQ(begin.plan, sample_pass().plan);
    EXPECT_EQ(begin.tree_hash, 99u);
    const auto work = std::get<Work>(samples()[7]);
    EXPECT_EQ(std::get<Work>(decode(encode(work))), work);

    const Result sent = sample_result();
    const auto got = std::get<Result>(decode(encode(sent)));
    EXPECT_EQ(got.incarnation, sent.incarnation);
    EXPECT_EQ(got.evidence, sent.evidence);
    EXPECT_EQ(got.stats.paths, 24u);
    EXPECT_EQ(got.stats.split_path_rays, 7u);
    ASSERT_EQ(got.stats.first_invalid.size(), 1u);
    EXPECT_EQ(got.stats.first_invalid[0].sample, 5u);
    EXPECT_EQ(got.stats.tails, sent.stats.tails);
    EXPECT_EQ(got.splats, sent.splats);
    ASSERT_EQ(got.units.size(), 5u);
    for (std::size_t k = 0; k < got.units.size(); ++k) {
        EXPECT_EQ(got.units[k].unit, sent.units[k].unit);
        EXPECT_EQ(got.units[k].pixels.size(), sent.units[k].pixels.size());
    }
    for (std::size_t p = 0; p < 6; ++p)
        for (int half = 0; half < 2; ++half) {
            EXPECT_EQ(got.units[1].aovs.direct[p].half[half].n, sent.units[1].aovs.direct[p].half[half].n);
            EXPECT_EQ(got.units[1].aovs.direct[p].half[half].mean, sent.units[1].aovs.direct[p].half[half].mean);
            EXPECT_EQ(got.units[1].pixels[p].half[half].n, sent.units[1].pixels[p].half[half].n);
            EXPECT_EQ(got.units[1].pixels[p].half[half].mean, sent.units[1].pixels[p].half[half].mean);
            EXPECT_EQ(got.units[1].pixels[p].half[half].m2, sent.units[1].pixels[p].half[half].m2);
        }
}

TEST(Protocol, TruncationAtEveryByteIsRefused) {
    for (const Message& message : samples()) {
        const Bytes bytes = encode_any(message);
        for (std::size_t length = 0; length < bytes.size(); ++length)
            EXPECT_THROW(decode(std::span(bytes).first(length)), FormatError)
                << "kind " << message.index() + 1 << " cut at " << length;
    }
}

TEST(Protocol, CorruptionOfAnyByteIsRefused) {
    for (const Message& message : samples()) {
        const Bytes bytes = encode_any(message);
        for (std::size_t at = 0; at < bytes.size(); ++at)
            for (const int flip : {0x01, 0x80, 0xff}) {
                Bytes damaged = bytes;
                damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ flip);
                EXPECT_THROW(decode(damaged), FormatError) << "kind " << message.index() + 1 << " byte " << at;
            }
    }
}

TEST(Protocol, ExtraBytesAreRefused) {
    for (const Message& message : samples()) {
        Bytes bytes = encode_any(message);
        bytes.push_back(0);
        EXPECT_THROW(decode(bytes), FormatError);
    }
}

/// Puts a right checksum on a message whose content was changed: what a checksum cannot catch must be caught by decode.
Bytes resealed(Bytes bytes) {
    const std::uint64_t length = bytes.size() - kEnvelopeBytes;
    std::memcpy(bytes.data() + 16, &length, sizeof length);
    const std::uint64_t checksum = hash_bytes(std::span(bytes).subspan(16));
    std::memcpy(bytes.data() + 8, &checksum, sizeof checksum);
    return bytes;
}

TEST(Protocol, WrongContentUnderARightChecksumNeverCrashes) {
    for (const Message& message : samples()) {
        const Bytes bytes = encode_any(message);
        for (std::size_t at = kEnvelopeBytes - 1; at < bytes.size(); ++at)
            for (const int value : {0x00, 0x7f, 0x80, 0xff}) {
                Bytes damaged = bytes;
                damaged[at] = static_cast<std::uint8_t>(value);
                try {
                    decode(resealed(std::move(damaged)));
                } catch (const FormatError&) {
                }
            }
        for (std::size_t length = kEnvelopeBytes; length < bytes.size(); ++length)
            EXPECT_THROW(decode(resealed({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)})),
                         FormatError)
                << "kind " << message.index() + 1 << " cut at " << length;
    }
}

TEST(Protocol, UnitsThatCannotBeAreRefused) {
    const auto refused = [](const WorkUnit& unit) {
        const Bytes bytes = encode(Work{0, {unit}});
        EXPECT_THROW(decode(bytes), FormatError);
    };
    refused({0, 3, 0, 3, 1, 0});
    refused({.kind = UnitKind::light_paths, .first = 3, .count = 0});
    refused({.kind = UnitKind::light_paths, .first = ~std::uint64_t{0}, .count = 2});
    refused({.kind = UnitKind::chains, .first = 3, .count = 0});
    refused({.kind = static_cast<UnitKind>(kUnitKinds), .count = 1});
    PassBegin begin = sample_pass();
    begin.plan.units.tiles = false;  // of what are there estimates then?
    EXPECT_THROW(decode(encode(begin)), FormatError);
    begin.plan.layers.estimates = false;
    EXPECT_NO_THROW(decode(encode(begin)));
    begin.plan.layers.splats.exponent = 300;
    EXPECT_THROW(decode(encode(begin)), FormatError);
}

TEST(Protocol, AbsurdCountsAreRefusedBeforeAllocation) {
    EnvelopeWriter refuse(Kind::refuse);
    refuse.body().put_varint(std::uint64_t{1} << 60);
    EXPECT_THROW(decode(refuse.seal()), FormatError);
    EnvelopeWriter work(Kind::work);
    work.body().put<std::uint32_t>(0);
    work.body().put_varint(std::uint64_t{1} << 40);
    EXPECT_THROW(decode(work.seal()), FormatError);
    EnvelopeWriter chunk(Kind::chunk);
    chunk.body().put<std::uint8_t>(0);
    chunk.body().put<std::uint32_t>(0);
    chunk.body().put<std::uint64_t>(10);
    chunk.body().put<std::uint64_t>(8);
    chunk.body().put_varint(0);
    const Bytes three(3);
    chunk.body().put_array(std::span<const std::uint8_t>(three));
    EXPECT_THROW(decode(chunk.seal()), FormatError) << "beyond the end of its blob";
}

TEST(Protocol, AnotherVersionIsNamedInTheMessage) {
    Bytes bytes = encode(Quit{});
    bytes[4] = static_cast<std::uint8_t>(kProtocolVersion + 1);
    try {
        decode(bytes);
        FAIL() << "accepted";
    } catch (const FormatError& error) {
        EXPECT_NE(std::string(error.what()).find("protocol version " + std::to_string(kProtocolVersion + 1)),
                  std::string::npos)
            << error.what();
    }
}

TEST(Protocol, UnitsThatDifferInTheirSamplesAreAnError) {
    Result result = sample_result();
    result.units[0].pixels[3].add(3, Rgb(0.0f));
    EXPECT_THROW(encode(result), RunError);
}

TEST(Protocol, LightOfUnknownOriginIsRefused) {
    Result result = sample_result();
    result.stats.tails.worst[0].origin.path_class = static_cast<PathClass>(6);
    EXPECT_THROW(decode(encode(result)), FormatError);
    result.stats.tails.worst[0].origin = {static_cast<LightFound>(4), PathClass::mirror, 2};
    EXPECT_THROW(decode(encode(result)), FormatError);
}

TEST(Fingerprint, IsStableAndSensitive) {
    const Fingerprint own = own_fingerprint();
    EXPECT_EQ(own.hash(), own_fingerprint().hash());
    Fingerprint other = own;
    other.version += "x";
    EXPECT_NE(other.hash(), own.hash());
    other = own;
    other.float_control ^= 0x8000;
    EXPECT_NE(other.hash(), own.hash());
    other = own;
    other.probes ^= 1;
    EXPECT_NE(other.hash(), own.hash());
    // Two builds of one version.
    EXPECT_NE(own.program, 0u);
    other = own;
    other.program ^= 1;
    EXPECT_NE(other.hash(), own.hash());
    for (const auto part :
         {&Fingerprint::source, &Fingerprint::options, &Fingerprint::embree, &Fingerprint::compiler}) {
        other = own;
        other.*part += "x";
        EXPECT_NE(other.hash(), own.hash());
        EXPECT_NE(other.text(), own.text());
    }
}

}  // namespace
}  // namespace treefarm
