// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "common/decide/decisions.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kPass = 5;
constexpr std::array<BlockShape, 5> kShapes = {{{"energy", "quanta", BlockKind::sums, 40, 2, 1u << 30},
                                                {"moments", "quanta", BlockKind::signed_sums, 20, 3, 1u << 30},
                                                {"emitters", "paths", BlockKind::sums, kGrowingRows, 2},
                                                {"photons", "", BlockKind::chosen, 16, 2},
                                                {"chains", "weight", BlockKind::owned, 500, 1, 1u << 30}}};
enum Sums : std::size_t { kEnergy, kMoments, kEmitters };

Blocks no_blocks() {
    return Blocks(kShapes, kPass);
}

/// What number `work` of a pass's pieces of work teaches.
void teach(Blocks& blocks, std::uint32_t work) {
    std::mt19937 random(work);
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random()) % end; };
    blocks.sums(kEnergy).add(below(80), below(1000));
    blocks.sums(kMoments).add_signed(below(60), static_cast<int>(below(200)) - 100);
    const std::uint32_t emitter = below(9);
    blocks.sums(kEmitters).grow(emitter + 1);
    blocks.sums(kEmitters).add(2 * emitter, 1 + below(5));
    const std::array<std::uint32_t, 2> photon = {work, below(7)};
    blocks.chosen(0).offer(work, photon);
    if (work % 2 == 0) {
        const std::array<std::uint64_t, 1> weight = {below(100)};
        blocks.owned(0).set(work, weight);
    }
}

constexpr std::uint32_t kWork = 400;

Blocks whole() {
    Blocks blocks = no_blocks();
    for (std::uint32_t work = 0; work < kWork; ++work)
        teach(blocks, work);
    return blocks;
}

Bytes encoded(const Blocks& blocks) {
    const Blocks* const owners[] = {&blocks};
    return encode_evidence(kPass, owners);
}

void merge(Blocks& into, const Bytes& part) {
    Blocks* const owners[] = {&into};
    merge_evidence(kPass, owners, part);
}

TEST(Evidence, PartsInAnyOrderGiveTheSameBits) {
    const Blocks expected = whole();
    EXPECT_EQ(expected.chosen(0).size(), 16u);
    EXPECT_EQ(expected.owned(0).size(), kWork / 2);
    std::mt19937 random(3);
    for (const std::uint32_t count : {1u, 2u, 3u, 5u, 17u}) {
        std::vector<Blocks> parts(count, no_blocks());
        for (std::uint32_t work = 0; work < kWork; ++work)
            teach(parts[random() % count], work);
        std::shuffle(parts.begin(), parts.end(), random);
        Blocks merged = no_blocks(), added = no_blocks();
        for (const Blocks& part : parts) {
            merge(merged, encoded(part));
            added.add(part);
        }
        EXPECT_EQ(merged, expected) << count;
        EXPECT_EQ(added, expected) << count;
        EXPECT_EQ(encoded(merged), encoded(expected)) << count;
    }
}

TEST(Evidence, RangesOfRowsMergeToTheBlock) {
    const Blocks all = whole();
    for (const Sums number : {kEnergy, kMoments, kEmitters}) {
        const SumBlock& block = all.sums(number);
        SumBlock merged(block.shape());
        for (const RowRange rows : {RowRange{11, kGrowingRows}, RowRange{0, 4}, RowRange{4, 4}, RowRange{4, 11}}) {
            ByteWriter out;
            block.write(out, rows);
            const Bytes bytes = out.take();
            ByteReader checked(bytes), in(bytes);
            block.check(checked);
            checked.expect_end();
            merged.merge(in);
        }
        EXPECT_EQ(merged, block) << block.shape().name;
    }
}

/// Whatever the bytes: they are taken as a whole, or refused and nothing is changed.
TEST(Evidence, DamagedBytesAreRefusedAsAWhole) {
    Blocks part = no_blocks(), before = no_blocks();
    for (std::uint32_t work = 0; work < 20; ++work)
        teach(part, work);
    for (std::uint32_t work = 100; work < 120; ++work)
        teach(before, work);
    const Bytes bytes = encoded(part);
    int refused = 0;
    const auto expect_whole = [&](const Bytes& damaged) {
        Blocks into = before;
        try {
            merge(into, damaged);
        } catch (const FormatError&) {
            ++refused;
            EXPECT_EQ(into, before);
        }
    };
    for (std::size_t length = 0; length < bytes.size(); ++length)
        expect_whole(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)));
    EXPECT_EQ(refused, static_cast<int>(bytes.size())) << "each cut is seen";
    for (std::size_t at = 0; at < bytes.size(); ++at)
        for (const int bit : {0, 3, 7}) {
            Bytes damaged = bytes;
            damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 1 << bit);
            expect_whole(damaged);
        }
}

TEST(Evidence, WhatDoesNotFitIsRefusedByName) {
    const auto why = [](const Bytes& part, Blocks into) -> std::string {
        try {
            merge(into, part);
        } catch (const FormatError& error) {
            return error.what();
        }
        return "";
    };
    const auto taught = [](auto teach_it) {
        Blocks blocks = no_blocks();
        teach_it(blocks);
        return blocks;
    };
    const Blocks none = no_blocks();
    EXPECT_EQ(why(encoded(none), none), "");
    EXPECT_EQ(why(encode_evidence(6, {}), none), "evidence of pass 6 instead of 5");
    Bytes longer = encoded(none);
    longer.push_back(0);
    EXPECT_NE(why(longer, none), "");
    const Blocks large = taught([](Blocks& b) { b.sums(kEnergy).add(0, (1u << 30) + 1); });
    EXPECT_EQ(why(encoded(large), none), "evidence with an entry that is too large in \"energy\"");
    const Blocks low = taught([](Blocks& b) { b.sums(kMoments).add_signed(0, -(std::int64_t{1} << 50)); });
    EXPECT_EQ(why(encoded(low), none), "evidence with an entry that is too large in \"moments\"");
    const Blocks one = taught([](Blocks& b) { teach(b, 2); });
    EXPECT_EQ(why(encoded(one), one), "evidence with a record that is there already in \"photons\"");
    const Blocks chain = taught([](Blocks& b) { b.owned(0).set(2, std::array<std::uint64_t, 1>{1}); });
    EXPECT_EQ(why(encoded(chain), chain), "evidence with a row that is set already in \"chains\"");
    std::array<BlockShape, 5> larger = kShapes;
    larger[0].rows = 41;
    EXPECT_EQ(why(encoded(Blocks(larger, kPass)), none), "evidence with 41 rows of \"energy\" instead of 40");
    Blocks changed = chain;
    EXPECT_THROW(changed.add(Blocks(larger, kPass)), RunError);
    EXPECT_THROW(changed.owned(0).set(2, std::array<std::uint64_t, 1>{1}), RunError);
    EXPECT_THROW(changed.owned(0).set(500, std::array<std::uint64_t, 1>{1}), RunError);
    EXPECT_THROW(changed.chosen(0).offer(1, std::array<std::uint32_t, 1>{1}), RunError);
}

TEST(Evidence, SumsStayAtTheLargestNumberAndAreCounted) {
    constexpr std::array<BlockShape, 1> kOne = {{{"light", "quanta"}}};
    Blocks part(kOne), sum(kOne);
    part.sums(0).add(0, std::uint64_t{1} << 63);
    for (int k = 0; k < 3; ++k)
        merge(sum, encoded(part));
    EXPECT_EQ(sum.sums(0).values()[0], ~std::uint64_t{0});
    EXPECT_EQ(sum.saturated(), 1u);
    Blocks again(kOne);
    merge(again, encoded(sum));
    EXPECT_EQ(again, sum);
}

/// A total may be larger than what a message may have.
TEST(Evidence, LimitsOfMessagesAreNotThoseOfTotals) {
    constexpr std::array<BlockShape, 1> kOne = {{{"vertices", "vertices", BlockKind::sums, 1, 1, 100}}};
    Blocks part(kOne), sum(kOne), restored(kOne);
    part.sums(0).add(0, 100);
    for (int k = 0; k < 2; ++k)
        merge(sum, encoded(part));
    Blocks* const owners[] = {&restored};
    EXPECT_THROW(merge_evidence(kPass, owners, encoded(sum)), FormatError);
    merge_evidence(kPass, owners, encoded(sum), EvidencePart::total);
    EXPECT_EQ(restored, sum);
}

/// Each record is kept with the same probability, which the block knows.
TEST(ChosenBlock, KeepsASampleOfKnownShare) {
    constexpr std::uint32_t kRecords = 1000, kKeys = 400;
    double sum = 0, squares = 0;
    for (std::uint32_t key = 0; key < kKeys; ++key) {
        ChosenBlock block({"records", "", BlockKind::chosen, 50, 1}, key);
        for (std::uint32_t i = 0; i < kRecords; ++i)
            block.offer(i, std::array<std::uint32_t, 1>{i % 10});
        ASSERT_EQ(block.size(), 50u);
        double estimate = 0;
        for (std::size_t i = 0; i < block.size(); ++i)
            estimate += block.words(i)[0] / block.kept_share();
        sum += estimate;
        squares += estimate * estimate;
    }
    const double mean = sum / kKeys, error = std::sqrt((squares / kKeys - mean * mean) / kKeys);
    EXPECT_NEAR(mean, 4.5 * kRecords, 4 * error);
    EXPECT_LT(error, 0.02 * mean);
    ChosenBlock few({"records", "", BlockKind::chosen, 50, 1}, 0);
    few.offer(1, std::array<std::uint32_t, 1>{1});
    EXPECT_EQ(few.kept_share(), 1.0);
}

template <class... D>
void expect_shapes_fit(DecisionList<D...>) {
    const auto expect_one = []<class Sums>() {
        if (Sums::kBlock.rows == kGrowingRows) return;
        EXPECT_EQ(count_sums<Sums>(), Sums::kBlock.columns) << Sums::kBlock.name;
    };
    (expect_one.template operator()<typename D::Evidence>(), ...);
}

TEST(DeclaredSums, HaveTheSizeOfTheirBlocks) {
    expect_shapes_fit(Decisions());
}

TEST(DeclaredSums, ComeBackFromTheirBlocks) {
    Decisions::Evidence sums;
    sums.get<SplittingSums>() = {1, 2, 3, std::uint64_t{1} << 63};
    sums.get<NextEventSums>() = {9, 8, 7, 6, 5, 4, ~std::uint64_t{0}};
    sums.get<UnguidedSums>().guided[63] = 11;
    sums.get<UnguidedSums>().cost = 13;
    sums.get<LightSubpathSums>() = {21, 22, 23, 24, 25, 26};
    sums.get<EmissionSums>() = {{1, 0, 3}, {4, 5, 0}};
    Blocks sent = Decisions::blocks(), received = Decisions::blocks();
    Decisions::put(sums, sent);
    merge(received, encoded(sent));
    const Decisions::Evidence back = Decisions::evidence(received);
    EXPECT_EQ(back.get<SplittingSums>().unsplit_variance, std::uint64_t{1} << 63);
    EXPECT_EQ(back.get<NextEventSums>(), sums.get<NextEventSums>());
    EXPECT_EQ(back.get<UnguidedSums>().guided[63], 11u);
    EXPECT_EQ(back.get<UnguidedSums>().cost, 13u);
    EXPECT_EQ(back.get<LightSubpathSums>(), sums.get<LightSubpathSums>());
    EXPECT_EQ(back.get<EmissionSums>().paths, (std::vector<std::uint64_t>{1, 0, 3}));
    EXPECT_EQ(back.get<EmissionSums>().squares, (std::vector<std::uint64_t>{4, 5, 0}));
}

}  // namespace
}  // namespace treefarm
