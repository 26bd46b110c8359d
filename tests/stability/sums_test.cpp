// SPDX-License-Identifier: Apache-2.0
// Exact sums: their range, their caps, and their independence of any order.
#include <algorithm>
#include <random>

#include "common/base/error.h"
#include "common/guiding/regions/mixture.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/hard_case.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

SdTree one_region(float radiance_scale) {
    return initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), radiance_scale);
}

/// 27 | More records than a float can count
/// Others: sums and statistical weights in float stood still at 2^24 (practical-path-guiding, measured).
/// Here: sums are integers of 64 bits.
/// Holds: 2^25 counts and 2^25 records of one quantum, then 2^31 more counts, give exactly that many.
TEST(Sums, CountBeyondFloats) {
    CellSums sums(0, 1, 256);
    constexpr std::uint64_t kMany = std::uint64_t{1} << 25;
    for (std::uint64_t i = 0; i < kMany; ++i) {
        sums.add_count(0, 1);
        sums.add_quanta(3, 1);
    }
    sums.add_count(0, std::uint64_t{1} << 31);
    EXPECT_EQ(sums.counts()[0], kMany + (std::uint64_t{1} << 31));
    EXPECT_EQ(sums.cells()[3], kMany);
    test::figure("records counted exactly", static_cast<double>(kMany));
}

/// ours | Caps of a contribution and of a cell
/// Others: nothing bounded what one record may add; one firefly ruled a region for ever.
/// Here: a contribution ends at 2^40 quanta, a cell at 2^64 - 1; both are counted and travel with the update.
/// Holds: values up to the largest float and infinity add exactly 2^40; cells saturate and never wrap, whether by
/// records, by adding sums or by merging updates; every cap is counted.
TEST(Sums, CapsAreMetAndCounted) {
    const LetFloatsBe hostile;  // numbers that are none come in
    for (const float huge : {1e30f, 3e38f, test::kInfinity}) {
        bool capped = false;
        EXPECT_EQ(quantise(huge, -16, 7u, capped), std::uint64_t{1} << 40);
        EXPECT_TRUE(capped);
    }
    CellSums sums(0, 1, 256);
    EXPECT_TRUE(sums.add_quanta(0, std::uint64_t(-1) - 5));
    EXPECT_FALSE(sums.add_quanta(0, 6));
    EXPECT_EQ(sums.cells()[0], std::uint64_t(-1));
    CellSums other(0, 1, 256);
    other.add_quanta(0, 12);
    other.add_quanta(1, std::uint64_t{1} << 63);
    sums.add(other);
    sums.merge_encoded(other.encode());
    EXPECT_EQ(sums.cells()[0], std::uint64_t(-1));
    EXPECT_EQ(sums.cells()[1], std::uint64_t(-1));
    EXPECT_EQ(sums.caps().saturated_cells, 2u);
    test::figure("saturated cells counted, of 2", static_cast<double>(sums.caps().saturated_cells));
}

/// ours | Records 2^40 apart within a region, regions 1e60 apart
/// Others: a sum in float forgets what is 2^24 times smaller than itself.
/// Here: quanta are whole; below one quantum a record is rounded up with the probability of its fraction. Each
/// region has a unit of its own.
/// Holds: within a region a record of 2^40 quanta and 1000 of one add exactly; 200,000 records of 2^-10 quanta add
/// up to their sum within 4.5 standard errors; units of regions reach from 1e-30 to 1e30 with the same relative
/// steps.
TEST(Sums, RangesWithinAndBetweenRegions) {
    CellSums sums(0, 1, 256);
    bool capped = false;
    sums.add_quanta(0, quantise(0x1.fffffep39f, 0, 0, capped));
    for (int i = 0; i < 1000; ++i)
        sums.add_quanta(0, quantise(1.0f, 0, static_cast<std::uint32_t>(i), capped));
    EXPECT_EQ(sums.cells()[0], static_cast<std::uint64_t>(0x1.fffffep39) + 1000);
    EXPECT_FALSE(capped);

    std::mt19937 random(4);
    constexpr int kRecords = 200'000;
    double small = 0;
    for (int i = 0; i < kRecords; ++i)
        small += static_cast<double>(quantise(0x1p-10f, 0, static_cast<std::uint32_t>(random()), capped));
    const double expected = kRecords * 0x1p-10;
    EXPECT_NEAR(small, expected, 4.5 * std::sqrt(expected));

    double worst = 0;
    for (const float mean : {1e-30f, 1e-10f, 1.0f, 1e10f, 1e30f}) {
        const std::uint64_t quanta = quantise(mean, quantum_exponent_for(mean), 0, capped);
        EXPECT_TRUE(quanta >= 1u << 15 && quanta <= 1u << 16) << mean;
        const double back = std::ldexp(static_cast<double>(quanta), quantum_exponent_for(mean));
        worst = std::max(worst, std::abs(back / double(mean) - 1.0));
    }
    EXPECT_LT(worst, 0x1p-15);

    // A region whose mean record is beyond the largest float keeps the largest unit, not that of 1.
    const SdTree bright = one_region(1e30f);
    CellSums huge(bright.pass, 1, bright.cell_count());
    huge.add_quanta(5, std::uint64_t{1} << 60);
    huge.add_count(0, 1);
    RefineReport report;
    EXPECT_EQ(refine(bright, huge, {.spatial_threshold = 1e18}, report).quantum_exponent[0],
              quantum_exponent_for(3e38f));
    EXPECT_FALSE(capped);
    test::figure("largest rounding of a record, of its value", worst);
}

/// ours | Thousands of updates in random order
/// Others: atomic float sums, and optimiser steps per record, depend on the order of arrival.
/// Here: integers, merged in any order.
/// Holds: 3,000 updates of 40 records, merged in three random orders, or by trees of sums, give the same sums,
/// bytes, refined tree and mixture, bit for bit.
TEST(Sums, ThousandsOfUpdatesInAnyOrder) {
    const SdTree tree = test::random_tree(3, 20000, 500, 1);
    const SdTreeSampler guide(tree);
    std::vector<Record> records = test::random_records(guide, 120'000, 9);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].reflected = records[i].value;
        records[i].bin = static_cast<std::uint8_t>(i % kMixtureBins);
    }
    std::vector<Bytes> updates;
    for (std::size_t first = 0; first < records.size(); first += 40) {
        CellAccumulator part(tree.pass, guide, DirectionalFilter::box, true);
        std::vector<std::uint32_t> counts(guide.region_count());
        for (std::size_t i = first; i < first + 40; ++i)
            ++counts[records[i].distribution];
        part.commit({&records[first], 40}, counts, {});
        updates.push_back(part.take().encode());
    }
    ASSERT_EQ(updates.size(), 3000u);
    std::mt19937 random(5);
    CellSums reference;
    Bytes refined;
    for (int order = 0; order < 3; ++order) {
        CellSums sums(tree.pass, guide.region_count(), guide.cell_count(), true);
        // The last time in eight groups that are added to each other.
        if (order < 2) {
            for (const Bytes& update : updates)
                sums.merge_encoded(update);
        } else {
            for (std::size_t group = 0; group < 8; ++group) {
                CellSums part(tree.pass, guide.region_count(), guide.cell_count(), true);
                for (std::size_t i = group; i < updates.size(); i += 8)
                    part.merge_encoded(updates[i]);
                sums.add(part);
            }
        }
        RefineReport report;
        SdTree next = refine(tree, sums, {.spatial_threshold = 500}, report);
        MixtureLearner().learn(tree, sums, report.origins, next);
        if (order == 0) {
            reference = sums;
            refined = encode_tree(next);
        }
        EXPECT_EQ(sums, reference);
        EXPECT_EQ(sums.encode(), reference.encode());
        EXPECT_EQ(encode_tree(next), refined);
        std::shuffle(updates.begin(), updates.end(), random);
    }
    test::figure("updates merged", static_cast<double>(updates.size()));
}

/// 40 | NaN and infinity from one worker
/// Others: [inferred] one NaN contaminates every sum that it is merged into.
/// Here: what is sent are integers, so no sum can hold NaN; an update that does not fit, or lies about itself,
/// changes nothing and is refused by name.
/// Holds: after each of 2,000 damaged updates (cut, flipped bits) the sums are either unchanged with an error, or
/// those of a well-formed update: refining them gives probabilities that sum to 2^30.
TEST(Sums, DamagedUpdatesChangeNothing) {
    const SdTree tree = one_region(1.0f);
    CellSums update(tree.pass, 1, tree.cell_count());
    for (std::uint32_t c = 0; c < tree.cell_count(); c += 3)
        update.add_quanta(c, c + 1);
    update.add_count(0, 50);
    const Bytes good = update.encode();
    std::mt19937 random(6);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        Bytes bad = good;
        if (i % 2 == 0)
            bad.resize(random() % bad.size());
        else
            bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
        CellSums sums(tree.pass, 1, tree.cell_count());
        const CellSums before = sums;
        try {
            sums.merge_encoded(bad);
        } catch (const FormatError&) {
            ++refused;
            ASSERT_EQ(sums, before);
            continue;
        }
        RefineReport report;
        const SdTree next = refine(tree, sums, {.spatial_threshold = 1e18}, report);
        std::uint64_t mass = 0;
        for (const std::uint32_t m : next.cell_mass)
            mass += m;
        ASSERT_EQ(mass, std::uint64_t{1} << kMassBits);
    }
    EXPECT_GT(refused, 1000);
    test::figure("damaged updates refused, of 2000", refused);
}

}  // namespace
}  // namespace treefarm
