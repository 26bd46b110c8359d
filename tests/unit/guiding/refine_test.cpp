// SPDX-License-Identifier: Apache-2.0
// Refinement, against hand-computed trees.
#include "common/guiding/sd_tree/refine.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/base/error.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"

namespace treefarm {
namespace {

const Box3 kUnitBox(Vec3(0.0f), Vec3(1.0f));

SdTree refined(const SdTree& tree, const CellSums& sums, double threshold = 1e18, RefineReport* report = nullptr) {
    RefineReport own;
    return refine(tree, sums, {.spatial_threshold = threshold}, report ? *report : own);
}

CellSums sums_for(const SdTree& tree) {
    return CellSums(tree.pass, tree.region_count(), tree.cell_count());
}

std::uint64_t mass_of(const SdTree& tree, std::uint32_t region) {
    return std::accumulate(tree.cell_mass.begin() + tree.cell_begin[region],
                           tree.cell_mass.begin() + tree.cell_begin[region + 1], std::uint64_t{0});
}

TEST(InitialTree, IsOneEvenRegionOverACube) {
    const SdTree tree = initial_tree(Box3(Vec3(-1, 0, 2), Vec3(1, 3, 3)), 1.0f);
    EXPECT_FALSE(tree.trained);
    EXPECT_EQ(tree.region_count(), 1u);
    EXPECT_EQ(tree.cell_count(), 256u);
    EXPECT_EQ(tree.extent, 3.0f);
    EXPECT_EQ(mass_of(tree, 0), std::uint64_t{1} << kMassBits);
}

TEST(InitialTree, OfAPointOrNothingIsStillACube) {
    EXPECT_GT(initial_tree(Box3(Vec3(5.0f), Vec3(5.0f)), 1.0f).extent, 0.0f);
    EXPECT_GT(initial_tree(Box3(), 0.0f).extent, 0.0f);
}

TEST(Refine, WithoutEnergyStaysEven) {
    const SdTree first = initial_tree(kUnitBox, 1.0f);
    const SdTree next = refined(first, sums_for(first));
    EXPECT_TRUE(next.trained);
    EXPECT_EQ(next.pass, 1u);
    EXPECT_EQ(next.cell_depth, first.cell_depth);
    EXPECT_EQ(next.cell_mass, first.cell_mass);
    EXPECT_EQ(next.quantum_exponent, first.quantum_exponent);
}

TEST(Refine, SplitsABrightCellUntilNoneHoldsMoreThanAHundredth) {
    const SdTree first = initial_tree(kUnitBox, 1.0f);
    CellSums sums = sums_for(first);
    sums.add_quanta(0, 1'000'000);  // all energy in the first cell, at depth 4
    sums.add_count(0, 10);
    const SdTree next = refined(first, sums);
    // The cell splits evenly 4 times: 4^4 = 256 parts of 1/256 < 1/100 each; 4^3 = 64 parts would be above.
    EXPECT_EQ(std::count(next.cell_depth.begin(), next.cell_depth.end(), 8), 256);
    // Everything else is pruned: three empty siblings at each of the depths 4, 3, 2, 1.
    EXPECT_EQ(next.cell_count(), 256u + 4 * 3u);
    EXPECT_EQ(mass_of(next, 0), std::uint64_t{1} << kMassBits);
    for (std::uint32_t c = 0; c < 256; ++c)
        EXPECT_EQ(next.cell_mass[c], 1u << (kMassBits - 8));
    for (std::uint32_t c = 256; c < next.cell_count(); ++c)
        EXPECT_EQ(next.cell_mass[c], 0u);
}

TEST(Refine, ThresholdIsExclusive) {
    // 100 equal cells of 256: each holds exactly one hundredth, which is not more than one hundredth.
    const SdTree first = initial_tree(kUnitBox, 1.0f);
    CellSums sums = sums_for(first);
    for (std::uint32_t c = 0; c < 100; ++c)
        sums.add_quanta(c, 7);
    sums.add_count(0, 1);
    for (const int depth : refined(first, sums).cell_depth)
        EXPECT_LE(depth, 4);
}

TEST(Refine, ATreeThatIsSeldomSampledGetsFewerCells) {
    // 64 equal cells: each holds 1/64, more than a hundredth and less than a fiftieth.
    const auto cells_at = [](float bsdf_fraction, double least_use) {
        SdTree first = initial_tree(kUnitBox, 1.0f, bsdf_fraction);
        CellSums sums = sums_for(first);
        for (std::uint32_t c = 0; c < 64; ++c)
            sums.add_quanta(c, 7);
        sums.add_count(0, 1);
        RefineReport report;
        return refine(first, sums, {.spatial_threshold = 1e18, .least_use = least_use}, report).cell_count();
    };
    const std::uint32_t fine = cells_at(0.5f, 0.5), coarse = cells_at(1.0f, 0.5);
    EXPECT_EQ(fine, 3 + 4 * 64u);  // one quarter of the directions, its 64 cells split, the other three pruned
    EXPECT_EQ(coarse, 3 + 64u);
    EXPECT_EQ(cells_at(0.1f, 0.5), fine);      // never finer than asked
    EXPECT_EQ(cells_at(1.0f, 1.0), fine);      // as published
    EXPECT_EQ(cells_at(0.74f, 0.01), coarse);  // 52 parts: 1/64 does not split
    EXPECT_EQ(cells_at(1.0f, 0.1), 3 + 16u);   // 10 parts: 1/16 does not split, 1/4 does
}

TEST(Refine, SplitsRegionsByWeightHalvingIt) {
    const SdTree first = initial_tree(kUnitBox, 1.0f);
    CellSums sums = sums_for(first);
    sums.add_count(0, 1000);
    RefineReport report;
    const SdTree next = refined(first, sums, 250.0, &report);
    EXPECT_EQ(next.region_count(), 4u);  // 1000 -> 500 -> 250, which is not more than 250
    EXPECT_EQ(report.spatial_depth, 2);
    const SdTreeSampler guide(next);
    // Axes cycle x, y, z: z does not matter yet, regions are numbered x-major.
    EXPECT_EQ(guide.region({0.2f, 0.2f, 0.9f}), 0u);
    EXPECT_EQ(guide.region({0.2f, 0.8f, 0.1f}), 1u);
    EXPECT_EQ(guide.region({0.8f, 0.2f, 0.1f}), 2u);
    EXPECT_EQ(guide.region({0.8f, 0.8f, 0.9f}), 3u);
}

TEST(Refine, KickstartRecordsWeighHalf) {
    const SdTree first = initial_tree(kUnitBox, 1.0f);
    CellSums sums = sums_for(first);
    sums.add_count(0, 1000);
    RefineReport report;
    const SdTree next = refine(first, sums, {.spatial_threshold = 500, .record_weight = 0.5}, report);
    EXPECT_EQ(next.region_count(), 1u);
}

TEST(Refine, QuantumFollowsTheMeanRecord) {
    const SdTree first = initial_tree(kUnitBox, 1.0f);
    CellSums sums = sums_for(first);
    for (int i = 0; i < 8; ++i)
        sums.add_quanta(17, std::uint64_t{1} << 35);  // 2^20 times the 2^15 expected of it
    sums.add_count(0, 8);
    EXPECT_EQ(refined(first, sums).quantum_exponent[0], first.quantum_exponent[0] + 20);
}

TEST(Refine, DepthLimitsAreCounted) {
    SdTree tree = initial_tree(kUnitBox, 1.0f);
    RefineReport report;
    for (int pass = 0; pass < 12; ++pass) {
        CellSums sums = sums_for(tree);
        const SdTreeSampler guide(tree);
        const std::uint32_t region = guide.region({0.3f, 0.3f, 0.3f});
        sums.add_quanta(guide.cell(region, 0x12345678u),
                        1u << 30);  // all light from one point, all records at one place
        sums.add_count(region, 1u << 30);
        tree = refined(tree, sums, 1e6, &report);
    }
    EXPECT_EQ(report.directional_depth, kMaxDirectionDepth);
    EXPECT_GT(report.directional_depth_capped, 0u);
    EXPECT_LE(report.spatial_depth, kMaxSpatialDepth);
    EXPECT_GT(report.spatial_depth_capped, 0u);
    for (std::uint32_t r = 0; r < tree.region_count(); ++r)
        EXPECT_EQ(mass_of(tree, r), std::uint64_t{1} << kMassBits);
}

TEST(Refine, RefusesForeignSums) {
    RefineReport report;
    EXPECT_THROW(refine(initial_tree(kUnitBox, 1.0f), CellSums(0, 1, 255), {}, report), RunError);
}

}  // namespace
}  // namespace treefarm
