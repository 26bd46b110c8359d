// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/message_script.h"

#include <limits>

#include "common/decide/decisions.h"
#include "common/evidence/evidence.h"

namespace treefarm::fuzz {

std::uint64_t Script::number() {
    static constexpr std::uint64_t kEdges[] = {0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 1ull << 40, ~0ull};
    switch (below(4)) {
        case 0:
            return below(4);
        case 1:
            return byte();
        case 2:
            return kEdges[below(std::size(kEdges))];
        default: {
            std::uint64_t value = 0;
            for (int i = 0; i < 8; ++i)
                value = value << 8 | byte();
            return value;
        }
    }
}

namespace {

/// Mostly what is known, sometimes anything.
template <class T>
T likely(Script& script, T known) {
    return script.one_in(6) ? static_cast<T>(script.number()) : known;
}

WorkUnit any_unit(Script& script, const Known& known) {
    if (!known.units.empty() && !script.one_in(4)) {
        const auto count = static_cast<std::uint32_t>(known.units.size());
        return known.units[script.below(count)];
    }
    if (script.one_in(4)) {
        WorkUnit range{.pass = known.pass, .kind = script.one_in(2) ? UnitKind::light_paths : UnitKind::chains};
        range.first = static_cast<std::uint32_t>(likely<std::uint64_t>(script, script.below(8)));
        range.count = 1 + script.below(8);
        return range;
    }
    WorkUnit unit{known.pass, 0, 0, 1, 1, 0};
    unit.x0 = static_cast<std::uint16_t>(likely<std::uint64_t>(script, script.below(8)));
    unit.y0 = static_cast<std::uint16_t>(likely<std::uint64_t>(script, script.below(8)));
    unit.x1 = static_cast<std::uint16_t>(std::min(65535, unit.x0 + 1 + static_cast<int>(script.below(8))));
    unit.y1 = static_cast<std::uint16_t>(std::min(65535, unit.y0 + 1 + static_cast<int>(script.below(8))));
    if (unit.x0 >= unit.x1) unit.x0 = 0;
    if (unit.y0 >= unit.y1) unit.y0 = 0;
    unit.chunk = likely(script, 0u);
    return unit;
}

double any_value(Script& script) {
    static constexpr double kValues[] = {
        0, 1, -1, 1e300, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    return kValues[script.below(std::size(kValues))];
}

/// Splats of the pass's film, of which some bytes may be wrong.
Bytes any_splats(Script& script, const Known& known) {
    SplatSums sums(SplatShape{static_cast<std::uint32_t>(known.width * known.height), -8});
    SplatLog log;
    log.begin(sums.shape());
    for (std::uint32_t count = script.below(4); count > 0; --count)
        log.add(script.below(8) % sums.shape().pixels, script.byte(), Rgb(1.0f), {});
    sums.add(log.summed(), log.caps());
    Bytes bytes = sums.encode();
    if (script.one_in(2)) bytes[script.byte() % bytes.size()] = script.byte();
    return bytes;
}

Result any_result(Script& script, const Known& known) {
    Result result;
    result.incarnation = likely(script, known.incarnation);
    result.pass = likely(script, known.pass);
    const std::uint32_t count = script.below(4);
    for (std::uint32_t u = 0; u < count; ++u) {
        UnitResult unit{any_unit(script, known), {}, {}};
        unit.unit.pass = result.pass;
        const std::uint32_t n[2] = {likely(script, 1u), likely(script, 1u)};
        Moments half[2];
        for (int h = 0; h < 2; ++h)
            half[h] = {n[h], Rgb64(any_value(script), any_value(script), 0), Rgb64(any_value(script), 0, 0)};
        if (!script.one_in(6)) unit.pixels.assign(unit.unit.pixel_count(), PixelEstimate{{half[0], half[1]}});
        result.units.push_back(std::move(unit));
    }
    if (script.one_in(2)) {
        const Blocks decided = Decisions::blocks();
        const Blocks* const owners[] = {&decided};
        result.evidence = encode_evidence(likely(script, known.pass), owners);
    }
    for (std::uint32_t length = script.below(40); length > 0; --length)
        result.evidence.push_back(script.byte());
    if (script.one_in(2)) result.splats = any_splats(script, known);
    TraceStats& s = result.stats;
    for (std::uint64_t* counter : {&s.nonzero_paths, &s.rays, &s.records, &s.invalid_samples})
        *counter = script.number();
    s.trace_seconds = any_value(script);
    s.busy_seconds = any_value(script);
    s.splat_seconds = any_value(script);
    for (std::uint32_t count = script.below(4); count > 0; --count)
        s.tails.worst.push_back({static_cast<float>(script.below(3)),
                                 result.pass,
                                 static_cast<std::uint16_t>(script.below(9)),
                                 0,
                                 script.below(4),
                                 {static_cast<LightFound>(script.below(5)), PathClass::diffuse, 1}});
    s.paths = std::numeric_limits<std::uint64_t>::max();  // what can be seen to be wrong
    return result;
}

Chunk any_chunk(Script& script, const Known& known) {
    Chunk chunk;
    chunk.blob = script.one_in(2) ? Blob::scene : Blob::tree;
    const Bytes& bytes = chunk.blob == Blob::scene ? known.scene : known.tree;
    chunk.job = likely(script, known.job);
    chunk.epoch = likely(script, chunk.blob == Blob::scene ? 0u : known.pass);
    chunk.total = likely<std::uint64_t>(script, bytes.size());
    chunk.offset = std::min(chunk.total, likely<std::uint64_t>(script, 0));
    const std::uint64_t length = std::min<std::uint64_t>(chunk.total - chunk.offset, bytes.size());
    chunk.bytes.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    if (!chunk.bytes.empty() && script.one_in(2)) chunk.bytes[script.byte() % chunk.bytes.size()] ^= 1;
    for (std::uint32_t hops = script.below(4); hops > 0; --hops)
        chunk.chain.push_back(likely(script, script.below(6)));
    return chunk;
}

PassBegin any_pass(Script& script, const Known& known) {
    PassBegin begin;
    begin.plan.index = likely(script, known.pass);
    begin.plan.spp = 1 + script.below(8);  // whoever may give orders may also ask for much work
    begin.plan.first_sample = likely(script, 0u);
    begin.plan.record = script.one_in(2);
    begin.plan.guided = script.one_in(2);
    begin.plan.learn_mixture = script.one_in(2);
    begin.plan.units.light_paths = script.one_in(3) ? script.below(4) : 0;
    if (script.one_in(3)) begin.plan.layers.splats = {static_cast<std::uint32_t>(known.width * known.height), -8};
    begin.tree_bytes = likely(script, known.tree_bytes);
    begin.tree_hash = likely(script, known.tree_hash);
    return begin;
}

}  // namespace

Bytes any_message(Script& script, const Known& known) {
    switch (1 + script.below(16)) {
        case 1:
            return encode(Hello{likely(script, known.incarnation), likely(script, known.fingerprint),
                                static_cast<std::uint32_t>(likely<std::uint64_t>(script, 2) % (kMostThreads + 1)),
                                likely(script, known.job), likely<std::uint64_t>(script, 0), script.number(), "rogue",
                                "0.0"});
        case 2:
            return encode(Welcome{1, 0.5, script.one_in(2) ? "" : "[farm]\nno_such_key = 1\n",
                                  likely(script, known.scene_hash), likely(script, known.scene_bytes),
                                  script.one_in(2)});
        case 3:
            return encode(Refuse{"no"});
        case 4:
            return encode(any_chunk(script, known));
        case 5:
            return encode(Resend{script.one_in(2) ? Blob::scene : Blob::tree, likely(script, known.job),
                                 likely(script, known.pass), likely<std::uint64_t>(script, 0)});
        case 6:
            return encode(any_pass(script, known));
        case 7:
            return encode(Want{likely(script, known.incarnation), likely(script, known.pass),
                               likely(script, script.below(8)),
                               script.one_in(4) ? script.number() : script.below(100)});
        case 8: {
            Work work{likely(script, known.pass), {}};
            for (std::uint32_t count = script.below(4); count > 0; --count)
                work.units.push_back(any_unit(script, known));
            work.alone = script.one_in(4);
            return encode(work);
        }
        case 9:
            return encode(any_result(script, known));
        case 10:
            return encode(Heartbeat{likely(script, known.incarnation), script.number(), script.number()});
        case 11:
            return encode(Failure{likely(script, known.incarnation), "fire\x1b[2J\n"});
        case 12:
            return encode(Rejoin{likely(script, known.job)});
        case 13:
            return encode(Quit{});
        case 14:
            return encode(Bye{likely(script, known.incarnation)});
        case 15:
            return encode(Leave{script.one_in(2)});
        default: {
            Drop drop{likely(script, known.pass), {}};
            for (std::uint32_t count = script.below(4); count > 0; --count)
                drop.units.push_back(any_unit(script, known));
            return encode(drop);
        }
    }
}

}  // namespace treefarm::fuzz
