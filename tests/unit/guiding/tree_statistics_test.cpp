// SPDX-License-Identifier: Apache-2.0
// What `treefarm inspect` says of a tree.
#include "common/guiding/sd_tree/tree_statistics.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/guiding/any_guide.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

constexpr double kPiDouble = 3.14159265358979;

template <class Counts>
std::uint64_t sum(const Counts& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TEST(QuantilesOf, AreNumbersOfTheList) {
    const Quantiles q = quantiles_of({5, 1, 4, 2, 3, 10, 9, 8, 7, 6});
    EXPECT_EQ(q.count, 10u);
    EXPECT_DOUBLE_EQ(q.mean, 5.5);
    EXPECT_EQ(q.least, 1);
    EXPECT_EQ(q.tenth, 1);
    EXPECT_EQ(q.median, 5);
    EXPECT_EQ(q.nine_tenths, 9);
    EXPECT_EQ(q.most, 10);
    EXPECT_EQ(quantiles_of({7}).tenth, 7);
    EXPECT_EQ(quantiles_of({}).count, 0u);
    EXPECT_EQ(quantiles_of({}).most, 0);
}

TEST(TreeStatistics, OfTheTreeBeforeAnyPass) {
    const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f, 0.5f);
    const TreeStatistics s = AnyModel(tree).statistics(77);
    EXPECT_FALSE(s.trained);
    EXPECT_EQ(s.regions, 1u);
    EXPECT_EQ(s.nodes, 1u);
    EXPECT_EQ(s.views, 0u);
    EXPECT_EQ(s.t2_share(), 0);
    EXPECT_EQ(s.region_depth, DepthCounts{1});
    EXPECT_EQ(s.region_cells, 256u);
    EXPECT_EQ(s.region_cell_depth, (DepthCounts{0, 0, 0, 0, 256}));
    EXPECT_EQ(s.regions_mixture.bsdf.mean, 0.5);
    EXPECT_EQ(s.regions_mixture.t1.mean, 0.5);
    EXPECT_EQ(s.encoded_bytes, 77u);
    EXPECT_EQ(s.memory_bytes, SdTreeSampler(tree).bytes());
}

class ViewTreeStatistics : public ::testing::Test {
  protected:
    SdTree tree = test::random_view_tree(5, 60000, 1500, 4000, 2);
    SdTreeSampler guide{tree};
    TreeStatistics s = AnyModel(tree).statistics(1);
};

TEST_F(ViewTreeStatistics, CountEverythingOnce) {
    EXPECT_GT(s.views, 0u);
    EXPECT_EQ(sum(s.region_depth), tree.region_count());
    EXPECT_EQ(sum(s.view_depth), tree.view_count());
    EXPECT_EQ(sum(s.region_cell_depth), s.region_cells);
    EXPECT_EQ(sum(s.view_cell_depth), s.view_cells);
    EXPECT_EQ(s.region_cells + s.view_cells, tree.cell_count());
    EXPECT_EQ(s.nodes, 2 * s.regions - 1);
    EXPECT_EQ(s.views_per_t2.count, s.t2s);
    EXPECT_EQ(s.cells_per_view.count, s.views);
    EXPECT_GT(s.regions_with_t2, 0u);
    double volume = 0, area = 0;
    for (std::size_t depth = 0; depth < s.region_depth.size(); ++depth)
        volume += std::ldexp(double(s.region_depth[depth]), -static_cast<int>(depth));
    for (std::size_t depth = 0; depth < s.region_cell_depth.size(); ++depth)
        area += std::ldexp(double(s.region_cell_depth[depth]), -2 * static_cast<int>(depth));
    EXPECT_DOUBLE_EQ(volume, 1.0) << "regions fill the cube";
    EXPECT_DOUBLE_EQ(area, s.regions) << "cells fill each region's square";
}

TEST_F(ViewTreeStatistics, FractionsSumToOne) {
    const MixtureQuantiles& views = s.views_mixture;
    EXPECT_NEAR(views.bsdf.mean + views.t1.mean + views.t2.mean, 1.0, 1e-6);
    EXPECT_EQ(s.regions_mixture.t2.most, 0);
    EXPECT_NEAR(s.regions_mixture.bsdf.mean + s.regions_mixture.t1.mean, 1.0, 1e-6);
}

TEST_F(ViewTreeStatistics, RegionsShareTheCellsOfTheirT2) {
    const std::vector<double> cells = cells_by_region(tree);
    EXPECT_NEAR(std::accumulate(cells.begin(), cells.end(), 0.0), tree.cell_count(), 1e-6 * tree.cell_count());
}

TEST_F(ViewTreeStatistics, MapsOfDensityAreWhatIsSampled) {
    constexpr int kBits = 5, kSide = 1 << kBits;
    for (std::uint32_t d = 0; d < tree.distribution_count(); d += 7) {
        const std::vector<float> map = density_map(tree, d, kBits);
        double integral = 0;
        for (std::size_t i = 0; i < map.size(); ++i) {
            integral += static_cast<double>(map[i]) * 4 * kPiDouble / (kSide * kSide);
            const Vec2 corner(static_cast<float>(i % kSide) / kSide, static_cast<float>(i / kSide) / kSide);
            const std::uint32_t code = square_to_code(corner);
            if (guide.cell_side(d, guide.cell(d, code)) < (1u << (kDirectionBits - kBits))) continue;
            EXPECT_NEAR(map[i], guide.pdf(d, code), 1e-5f * map[i]) << "where a cell covers the square";
        }
        EXPECT_NEAR(integral, 1.0, 1e-5);
    }
}

TEST_F(ViewTreeStatistics, CoarseMapsAreAveragesOfFineOnes) {
    const std::vector<float> fine = density_map(tree, 3, 8), coarse = density_map(tree, 3, 6);
    for (std::size_t y = 0; y < 64; ++y)
        for (std::size_t x = 0; x < 64; ++x) {
            double mean = 0;
            for (std::size_t k = 0; k < 16; ++k)
                mean += static_cast<double>(fine[(4 * y + k / 4) * 256 + 4 * x + k % 4]) / 16;
            EXPECT_NEAR(coarse[y * 64 + x], mean, 1e-5 * mean + 1e-9);
        }
}

}  // namespace
}  // namespace treefarm
