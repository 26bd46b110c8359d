// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/messages.h"

#include <cstdlib>

#include "common/protocol/archive.h"
#include "common/protocol/plan_fields.h"
#include "common/protocol/result_codec.h"

namespace treefarm {

// Fields of each small message, in the order of docs/design/protocol.md.

template <class Archive>
void serialize(Archive& a, Hello& m) {
    a(m.incarnation, m.fingerprint, m.threads, m.job, m.scene_hash, m.memory, m.host, m.version);
}

template <class Archive>
void serialize(Archive& a, Welcome& m) {
    a(m.worker, m.heartbeat_seconds, m.job, m.scene_hash, m.scene_bytes, m.keep_scene);
}

template <class Archive>
void serialize(Archive& a, Refuse& m) {
    a(m.reason);
}

template <class Archive>
void serialize(Archive& a, Resend& m) {
    a(m.blob, m.job, m.epoch, m.offset);
}

template <class Archive>
void serialize(Archive& a, PassBegin& m) {
    a(m.plan, m.tree_bytes, m.tree_hash, m.result_seconds);
}

template <class Archive>
void serialize(Archive& a, Want& m) {
    a(m.incarnation, m.pass, m.units, m.queued);
}

template <class Archive>
void serialize(Archive& a, Heartbeat& m) {
    a(m.incarnation, m.samples, m.rays);
}

template <class Archive>
void serialize(Archive& a, Failure& m) {
    a(m.incarnation, m.text);
}

template <class Archive>
void serialize(Archive& a, Rejoin& m) {
    a(m.job);
}

template <class Archive>
void serialize(Archive&, Quit&) {}

template <class Archive>
void serialize(Archive& a, Bye& m) {
    a(m.incarnation);
}

template <class Archive>
void serialize(Archive& a, Leave& m) {
    a(m.finalize);
}

namespace {

void check_length(const std::string& text, std::size_t most, const char* what) {
    if (text.size() > most) throw FormatError(std::string(what) + " of " + std::to_string(text.size()) + " bytes");
}

void check(const Hello& m) {
    if (m.threads > kMostThreads) throw FormatError("a worker of " + std::to_string(m.threads) + " threads");
    check_length(m.host, kMostNameBytes, "a host's name");
    check_length(m.version, kMostNameBytes, "a version");
}

void check(const Resend& m) {
    if (m.blob > Blob::tree) throw FormatError("a blob of unknown kind");
}

void check(const Welcome& m) {
    if (!(m.heartbeat_seconds > 0 && m.heartbeat_seconds < 1e6)) throw FormatError("an absurd heartbeat");
    check_length(m.job, kMostJobBytes, "a job");
}

void check(const Refuse& m) {
    check_length(m.reason, kMostTextBytes, "a reason");
}

void check(const Failure& m) {
    check_length(m.text, kMostTextBytes, "a failure");
}

void check(const PassBegin& m) {
    const PassPlan& plan = m.plan;
    const std::uint64_t unit_spp = std::uint64_t{kBlockSamples} * plan.blocks_per_unit;
    if (plan.spp == 0 || !std::has_single_bit(plan.blocks_per_unit) ||
        plan.chunks != (plan.spp + unit_spp - 1) / unit_spp || !(plan.record_weight >= 0 && plan.record_weight <= 1))
        throw FormatError("an absurd pass");
    if (!(m.result_seconds >= 0 && m.result_seconds < 1e6)) throw FormatError("an absurd time between results");
    const bool tiles_where_estimated = plan.units.tiles || !plan.layers.estimates;
    const bool chains_where_squared = !plan.layers.splats.chains || plan.units.chains > 0;
    if (!tiles_where_estimated || !chains_where_squared || std::abs(plan.layers.splats.exponent) > kMostSplatExponent)
        throw FormatError("a pass whose layers do not fit its units");
}

template <class M>
void check(const M&) {}

template <class M>
void write_body(ByteWriter& writer, const M& message) {
    WriteArchive archive(writer);
    archive(message);
}

void write_body(ByteWriter& writer, const Chunk& m) {
    writer.put(static_cast<std::uint8_t>(m.blob));
    writer.put(m.job);
    writer.put(m.epoch);
    writer.put(m.total);
    writer.put(m.offset);
    writer.put_array(std::span(m.chain));
    writer.put_array(std::span(m.bytes));
}

void write_units(ByteWriter& writer, std::span<const WorkUnit> units) {
    writer.put_varint(units.size());
    for (const WorkUnit& unit : units)
        write_unit(writer, unit);
}

std::vector<WorkUnit> read_units(ByteReader& reader, std::uint32_t pass) {
    const std::size_t count = reader.get_count(kLeastUnitBytes);
    std::vector<WorkUnit> units;
    units.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        units.push_back(read_unit(reader, pass));
    return units;
}

void write_body(ByteWriter& writer, const Work& m) {
    writer.put(m.pass);
    writer.put<std::uint8_t>(m.alone);
    write_units(writer, m.units);
}

void write_body(ByteWriter& writer, const Drop& m) {
    writer.put(m.pass);
    write_units(writer, m.units);
}

void write_body(ByteWriter& writer, const Result& m) {
    write_result(writer, m);
}

template <class M>
M read_body(ByteReader& reader) {
    M message;
    if constexpr (std::is_same_v<M, Chunk>) {
        const auto blob = reader.get<std::uint8_t>();
        if (blob > static_cast<std::uint8_t>(Blob::tree)) throw FormatError("a blob of unknown kind");
        message.blob = static_cast<Blob>(blob);
        message.job = reader.get<std::uint32_t>();
        message.epoch = reader.get<std::uint32_t>();
        message.total = reader.get<std::uint64_t>();
        message.offset = reader.get<std::uint64_t>();
        message.chain = reader.get_array<std::uint32_t>();
        message.bytes = reader.get_array<std::uint8_t>();
        if (message.offset > message.total || message.bytes.size() > message.total - message.offset)
            throw FormatError("a chunk beyond the end of its blob");
    } else if constexpr (std::is_same_v<M, Work>) {
        message.pass = reader.get<std::uint32_t>();
        const auto alone = reader.get<std::uint8_t>();
        if (alone > 1) throw FormatError("work that is neither alone nor not");
        message.alone = alone != 0;
        message.units = read_units(reader, message.pass);
    } else if constexpr (std::is_same_v<M, Drop>) {
        message.pass = reader.get<std::uint32_t>();
        message.units = read_units(reader, message.pass);
    } else if constexpr (std::is_same_v<M, Result>) {
        message = read_result(reader);
    } else {
        ReadArchive archive(reader);
        archive(message);
        check(message);
    }
    reader.expect_end();
    return message;
}

}  // namespace

bool PassBegin::operator==(const PassBegin& other) const {
    return encode(*this) == encode(other);
}

template <class M>
Bytes encode(const M& message) {
    EnvelopeWriter envelope(M::kKind);
    write_body(envelope.body(), message);
    return envelope.seal();
}

template Bytes encode(const Hello&);
template Bytes encode(const Welcome&);
template Bytes encode(const Refuse&);
template Bytes encode(const Chunk&);
template Bytes encode(const Resend&);
template Bytes encode(const PassBegin&);
template Bytes encode(const Want&);
template Bytes encode(const Work&);
template Bytes encode(const Result&);
template Bytes encode(const Heartbeat&);
template Bytes encode(const Failure&);
template Bytes encode(const Rejoin&);
template Bytes encode(const Quit&);
template Bytes encode(const Bye&);
template Bytes encode(const Leave&);
template Bytes encode(const Drop&);

Message decode(std::span<const std::uint8_t> bytes) {
    const Envelope envelope = open_envelope(bytes);
    ByteReader reader(envelope.payload);
    switch (envelope.kind) {
        case Kind::hello:
            return read_body<Hello>(reader);
        case Kind::welcome:
            return read_body<Welcome>(reader);
        case Kind::refuse:
            return read_body<Refuse>(reader);
        case Kind::chunk:
            return read_body<Chunk>(reader);
        case Kind::resend:
            return read_body<Resend>(reader);
        case Kind::pass_begin:
            return read_body<PassBegin>(reader);
        case Kind::want:
            return read_body<Want>(reader);
        case Kind::work:
            return read_body<Work>(reader);
        case Kind::result:
            return read_body<Result>(reader);
        case Kind::heartbeat:
            return read_body<Heartbeat>(reader);
        case Kind::failure:
            return read_body<Failure>(reader);
        case Kind::rejoin:
            return read_body<Rejoin>(reader);
        case Kind::quit:
            return read_body<Quit>(reader);
        case Kind::bye:
            return read_body<Bye>(reader);
        case Kind::leave:
            return read_body<Leave>(reader);
        case Kind::drop:
            return read_body<Drop>(reader);
    }
    throw FormatError("message of unknown kind");
}

}  // namespace treefarm
