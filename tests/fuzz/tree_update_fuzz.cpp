// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdlib>

#include "common/evidence/evidence.h"
#include "common/guiding/regions/light_probabilities.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/random_tree.h"

using namespace treefarm;

namespace {

const SdTree& small_tree() {
    static const SdTree tree = [] {
        SdTree grown = test::random_view_tree(2, 2000, 500, 500, 1);
        grown.light_probabilities.assign(grown.region_count(), kNothingLearned);
        return grown;
    }();
    return tree;
}

CellSums empty_sums() {
    const SdTree& tree = small_tree();
    return {tree.pass, SumsShape(tree.region_count(), tree.cell_count(), false, tree.view_count(), true)};
}

void merge(std::span<const std::uint8_t> bytes) {
    CellSums sums = empty_sums();
    try {
        sums.merge_encoded(bytes);
        CellSums again = empty_sums();
        again.merge_encoded(sums.encode());
        if (again != sums) std::abort();
    } catch (const FormatError&) {
        if (sums != empty_sums()) std::abort();  // a bad update changes nothing
    }
}

/// Blocks of each kind, into which something was merged before.
Evidence some_evidence(std::uint32_t first) {
    constexpr std::array<BlockShape, 5> kShapes = {{{"sums", "", BlockKind::sums, 9, 2, 1u << 20},
                                                    {"signed", "", BlockKind::signed_sums, 9, 2, 1u << 30},
                                                    {"growing", "", BlockKind::sums, kGrowingRows, 2},
                                                    {"chosen", "", BlockKind::chosen, 4, 2},
                                                    {"owned", "", BlockKind::owned, 50, 2}}};
    Blocks blocks(kShapes, 1);
    blocks.sums(0).add(first, 7);
    blocks.sums(1).add_signed(first, -7);
    blocks.sums(2).grow(first + 1);
    for (std::uint32_t i = first; i < first + 6; ++i) {
        blocks.chosen(0).offer(i, std::array<std::uint32_t, 2>{i, 3});
        blocks.owned(0).set(i, std::array<std::uint64_t, 2>{i, 3});
    }
    return {1, {std::move(blocks)}};
}

void merge_blocks(std::span<const std::uint8_t> bytes) {
    const Evidence before = some_evidence(0);
    Evidence evidence = before;
    try {
        evidence.merge_encoded(bytes);
        if (evidence.encode().empty()) std::abort();
    } catch (const FormatError&) {
        if (evidence != before) std::abort();  // bad evidence changes nothing
    }
}

void decode(std::span<const std::uint8_t> bytes) {
    try {
        const SdTree tree = decode_tree(bytes);
        const Bytes form = encode_tree(tree);
        if (encode_tree(decode_tree(form)) != form) std::abort();
        // What was read can be walked and sampled.
        const SdTreeSampler guide(tree);
        for (const float at : {0.0f, 0.3f, 1.0f})
            if (guide.region(tree.origin + Vec3(at * tree.extent)) >= tree.region_count()) std::abort();
        for (const std::uint32_t code : {0u, 0x77777777u, 0xffffffffu}) {
            const std::uint32_t view = guide.view(guide.region(tree.origin), code);
            if (view == SdTreeSampler::kNoView) continue;
            if (view < tree.region_count() || view >= tree.distribution_count()) std::abort();
            if (!(guide.pdf(view, code) >= 0.0f)) std::abort();
        }
    } catch (const FormatError&) {
    }
}

}  // namespace

/// 'u': an update of a certain tree follows; 't': a tree; 'b': evidence of certain blocks.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::uint8_t> rest(data + 1, size - 1);
    if (data[0] == 'u') merge(rest);
    if (data[0] == 't') decode(rest);
    if (data[0] == 'b') merge_blocks(rest);
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    const SdTreeSampler guide(small_tree());
    const auto text = [](char kind, const Bytes& bytes) {
        return std::string(1, kind) + std::string(bytes.begin(), bytes.end());
    };
    const auto update = [&](std::size_t count) {
        std::vector<Record> records = test::random_view_records(guide, count, 5);
        records.push_back(light_record(1, guide.quantum_exponent(1), 3, 0.5f, 2.0f));
        std::vector<std::uint32_t> counts(guide.distribution_count(), 1);
        CellAccumulator accumulator(small_tree().pass, guide);
        accumulator.commit(records, counts, {1, 2, 3});
        return accumulator.take().encode();
    };
    return {text('b', some_evidence(6).encode()), text('u', update(20)), text('u', empty_sums().encode()),
            text('t', encode_tree(small_tree())),
            text('t', encode_tree(initial_tree(Box3(Vec3(-1.0f), Vec3(1.0f)), 1.0f)))};
}
