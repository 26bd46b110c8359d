// SPDX-License-Identifier: Apache-2.0
// Exact sums: split, merged in any order, encoded, truncated, corrupted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

class TreeUpdate : public ::testing::Test {
  protected:
    SdTree tree = test::random_tree(3, 20000, 2000, 1);
    SdTreeSampler guide{tree};

    CellSums sums_of(std::vector<Record> records, const UpdateCaps& caps = {}) const {
        CellAccumulator accumulator(tree.pass, guide);
        std::vector<std::uint32_t> counts(guide.region_count());
        for (const Record& record : records)
            ++counts[record.distribution];
        accumulator.commit(records, counts, caps);
        return accumulator.take();
    }
};

TEST_F(TreeUpdate, SplitAndMergedInAnyOrderEqualsTheWhole) {
    const std::vector<Record> records = test::random_records(guide, 30000, 9);
    const CellSums whole = sums_of(records);
    std::mt19937 engine(4);
    for (int cut = 0; cut < 5; ++cut) {
        std::vector<Bytes> updates;
        for (std::size_t begin = 0; begin < records.size();) {
            const std::size_t end = std::min(records.size(), begin + 1 + engine() % 9000);
            updates.push_back(
                sums_of({records.begin() + static_cast<long>(begin), records.begin() + static_cast<long>(end)})
                    .encode());
            begin = end;
        }
        std::shuffle(updates.begin(), updates.end(), engine);
        CellSums merged(tree.pass, guide.region_count(), guide.cell_count());
        for (const Bytes& update : updates)
            merged.merge_encoded(update);
        EXPECT_EQ(merged, whole);
    }
}

TEST_F(TreeUpdate, ThreadsCommitToTheSameSums) {
    const std::vector<Record> records = test::random_records(guide, 40000, 10);
    CellAccumulator accumulator(tree.pass, guide);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (std::size_t part = 0; part < 10; ++part) {
                const auto begin = static_cast<long>((t * 10 + part) * 1000);
                std::vector<Record> own(records.begin() + begin, records.begin() + begin + 1000);
                std::vector<std::uint32_t> counts(guide.region_count());
                for (const Record& record : own)
                    ++counts[record.distribution];
                accumulator.commit(own, counts, {});
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(accumulator.take(), sums_of(records));
    EXPECT_EQ(accumulator.take(), CellSums(tree.pass, guide.region_count(), guide.cell_count()));
}

TEST_F(TreeUpdate, CodecKeepsEverything) {
    const CellSums sums = sums_of(test::random_records(guide, 5000, 11), {.capped_records = 3, .outside_positions = 5});
    CellSums decoded(tree.pass, guide.region_count(), guide.cell_count());
    const std::uint64_t touched = decoded.merge_encoded(sums.encode());
    EXPECT_EQ(decoded, sums);
    EXPECT_EQ(touched, static_cast<std::uint64_t>(
                           std::count_if(sums.cells().begin(), sums.cells().end(), [](auto s) { return s != 0; })));
    EXPECT_EQ(decoded.caps().outside_positions, 5u);
}

TEST_F(TreeUpdate, TakesAtMostTwelveBytesPerTouchedCell) {
    for (const std::size_t records : {100u, 10000u, 200000u}) {
        const Bytes update = sums_of(test::random_records(guide, records, 12)).encode();
        CellSums sums(tree.pass, guide.region_count(), guide.cell_count());
        EXPECT_LE(update.size(), 12 * sums.merge_encoded(update)) << records;
    }
}

TEST_F(TreeUpdate, CutShortItChangesNothing) {
    const Bytes update = sums_of(test::random_records(guide, 200, 13)).encode();
    CellSums sums(tree.pass, guide.region_count(), guide.cell_count());
    const CellSums empty = sums;
    for (std::size_t size = 0; size < update.size(); ++size) {
        EXPECT_THROW(sums.merge_encoded(std::span(update).first(size)), FormatError) << size;
        EXPECT_EQ(sums, empty);
    }
}

TEST_F(TreeUpdate, CorruptedItThrowsOrStaysInRange) {
    const Bytes update = sums_of(test::random_records(guide, 300, 14)).encode();
    for (std::size_t i = 0; i < update.size(); ++i) {
        Bytes bad = update;
        bad[i] = static_cast<std::uint8_t>(bad[i] ^ 0xff);
        CellSums sums(tree.pass, guide.region_count(), guide.cell_count());
        try {
            sums.merge_encoded(bad);  // the envelope's checksum catches what still parses
        } catch (const FormatError&) {
        }
    }
}

TEST_F(TreeUpdate, OfAnotherPassIsRefused) {
    const Bytes update = CellSums(tree.pass + 1, guide.region_count(), guide.cell_count()).encode();
    CellSums sums(tree.pass, guide.region_count(), guide.cell_count());
    EXPECT_THROW(sums.merge_encoded(update), FormatError);
}

TEST(CellSums, SaturateAndCountIt) {
    CellSums a(0, 1, 2), b(0, 1, 2);
    EXPECT_TRUE(a.add_quanta(0, ~std::uint64_t{0} - 5));
    EXPECT_FALSE(a.add_quanta(0, 6));
    EXPECT_EQ(a.cells()[0], ~std::uint64_t{0});
    EXPECT_TRUE(b.add_quanta(0, 1));
    a.add(b);
    EXPECT_EQ(a.cells()[0], ~std::uint64_t{0});
    EXPECT_EQ(a.caps().saturated_cells, 1u);
}

TEST(Quantise, IsExactForWholeQuantaAndUnbiasedBelow) {
    bool capped = false;
    EXPECT_EQ(quantise(3.0f, 0, 0, capped), 3u);
    EXPECT_EQ(quantise(3.0f, -4, 0xffffffffu, capped), 48u);
    EXPECT_EQ(quantise(0.0f, 0, 0, capped), 0u);
    std::mt19937 engine(1);
    double sum = 0;
    for (int i = 0; i < 100000; ++i)
        sum += static_cast<double>(quantise(0.3f, 2, static_cast<std::uint32_t>(engine()), capped));
    EXPECT_NEAR(sum / 100000, 0.075, 4 * std::sqrt(0.075 / 100000));
    EXPECT_FALSE(capped);
}

TEST(Quantise, CapsHugeAndInfiniteValues) {
    bool capped = false;
    EXPECT_EQ(quantise(1e30f, 0, 0, capped), std::uint64_t{1} << 40);
    EXPECT_TRUE(capped);
    capped = false;
    EXPECT_EQ(quantise(std::numeric_limits<float>::infinity(), 0, 0, capped), std::uint64_t{1} << 40);
    EXPECT_TRUE(capped);
}

}  // namespace
}  // namespace treefarm
