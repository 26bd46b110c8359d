// SPDX-License-Identifier: Apache-2.0
// How records spread: over directional cells, over regions, and into which target.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

/// One region with all cells of one depth.
SdTree even_tree(std::uint8_t depth) {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    const std::uint32_t cells = 1u << (2 * depth);
    tree.cell_begin = {0, cells};
    tree.cell_depth.assign(cells, depth);
    tree.cell_mass.assign(cells, (1u << kMassBits) / cells);
    return tree;
}

CellSums splat(const SdTree& tree, const std::vector<Record>& records, bool with_mixture = false) {
    const SdTreeSampler guide(tree);
    CellAccumulator accumulator(tree.pass, guide, DirectionalFilter::box, with_mixture);
    std::vector<std::uint32_t> counts(guide.region_count(), 1);
    accumulator.commit(records, counts, {});
    return accumulator.take();
}

std::uint32_t code_of(std::uint32_t x, std::uint32_t y) {
    return spread_bits(x) | (spread_bits(y) << 1);
}

double fraction(const CellSums& sums, std::uint32_t cell) {
    const double total =
        static_cast<double>(std::accumulate(sums.cells().begin(), sums.cells().end(), std::uint64_t{0}));
    return static_cast<double>(sums.cells()[cell]) / total;
}

TEST(BoxFilter, SpreadsByOverlap) {
    const SdTree tree = even_tree(2);
    const std::uint32_t side = 1u << (kDirectionBits - 2);
    // A quarter of a cell right of the centre of cell (1, 2), a quarter above.
    const std::uint32_t x = side + side / 2 + side / 4, y = 2 * side + side / 4;
    const CellSums sums = splat(tree, {{0, code_of(x, y), 12345, 1.0f}});
    const auto cell = [](std::uint32_t cx, std::uint32_t cy) { return spread_bits(cx) | (spread_bits(cy) << 1); };
    EXPECT_NEAR(fraction(sums, cell(1, 2)), 0.75 * 0.75, 1e-3);
    EXPECT_NEAR(fraction(sums, cell(2, 2)), 0.25 * 0.75, 1e-3);
    EXPECT_NEAR(fraction(sums, cell(1, 1)), 0.75 * 0.25, 1e-3);
    EXPECT_NEAR(fraction(sums, cell(2, 1)), 0.25 * 0.25, 1e-3);
}

TEST(BoxFilter, KeepsTheSumOnAnyTree) {
    const SdTree tree = test::random_tree(3, 20000, 2000, 1);
    const SdTreeSampler guide(tree);
    const std::vector<Record> records = test::random_records(guide, 20000, 5);
    std::vector<double> expected(tree.region_count()), got(tree.region_count());
    for (const Record& r : records)
        expected[r.distribution] += std::ldexp(static_cast<double>(r.value), -guide.quantum_exponent(r.distribution));
    const CellSums sums = splat(tree, records);
    for (std::uint32_t r = 0; r < tree.region_count(); ++r) {
        for (std::uint32_t c = tree.cell_begin[r]; c < tree.cell_begin[r + 1]; ++c)
            got[r] += static_cast<double>(sums.cells()[c]);
        EXPECT_NEAR(got[r], expected[r], 1e-3 * expected[r] + 100) << r;
    }
}

TEST(BoxFilter, BeyondAnEdgeGoesOnAcrossTheFold) {
    const SdTree tree = even_tree(3);
    const SdTreeSampler guide(tree);
    const std::uint32_t side = 1u << (kDirectionBits - 3);
    // On the right edge, three quarters up: half the square is beyond, where the map goes on mirrored.
    const std::uint32_t y = 6 * side + side / 2;
    const CellSums sums = splat(tree, {{0, code_of((1u << kDirectionBits) - 1, y), 99, 1.0f}});
    const std::uint32_t here = guide.cell(0, code_of((1u << kDirectionBits) - 1, y));
    const std::uint32_t across = guide.cell(0, code_of((1u << kDirectionBits) - 1, (1u << kDirectionBits) - 1 - y));
    EXPECT_NEAR(fraction(sums, here), 0.5, 1e-2);
    EXPECT_NEAR(fraction(sums, across), 0.5, 1e-2);
    // The two are neighbours on the sphere.
    const Vec3 a = square_to_direction({0.99999f, (static_cast<float>(y) + 0.5f) / 65536.0f});
    const Vec3 b = square_to_direction({0.99999f, 1.0f - (static_cast<float>(y) + 0.5f) / 65536.0f});
    EXPECT_GT(dot(a, b), 0.999f);
}

TEST(SpatialFilter, MovesByUpToHalfARegion) {
    SdTree tree = test::random_tree(3, 20000, 2000, 1);
    const SdTreeSampler guide(tree);
    std::mt19937 engine(3);
    const Vec3 p(0.3f, 0.6f, 0.2f);
    const std::uint32_t own = guide.region(p);
    int elsewhere = 0;
    for (int k = 0; k < 1000; ++k) {
        const Draw random{static_cast<std::uint32_t>(engine()), static_cast<std::uint32_t>(engine()),
                          static_cast<std::uint32_t>(engine()), 0};
        elsewhere += guide.region(guide.jittered(p, own, random)) != own;
    }
    EXPECT_GT(elsewhere, 100);
    EXPECT_LT(elsewhere, 1000);
    const Draw middle{1u << 31, 1u << 31, 1u << 31, 0};
    EXPECT_EQ(guide.region(guide.jittered(p, own, middle)), own);
}

TEST(SpatialFilter, MovesAcrossAWholeRegionAlongEachAxis) {
    const SdTree tree = test::random_tree(3, 20000, 2000, 1);
    const SdTreeSampler guide(tree);
    std::mt19937 engine(4);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (int k = 0; k < 100; ++k) {
        const Vec3 p = tree.origin + Vec3(uniform(engine), uniform(engine), uniform(engine)) * tree.extent;
        Vec3 low = tree.origin, size(tree.extent);
        std::uint32_t at = 0;
        for (int axis = 0; !tree.nodes[at].is_leaf(); axis = (axis + 1) % 3) {
            size[axis] /= 2.0f;
            const bool upper = p[axis] >= low[axis] + size[axis];
            if (upper) low[axis] += size[axis];
            at = tree.nodes[at].child[upper];
        }
        const std::uint32_t region = tree.nodes[at].child[1];
        const Vec3 least = guide.jittered(p, region, {0, 0, 0, 0});
        const Vec3 most = guide.jittered(p, region, {~0u, ~0u, ~0u, 0});
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(p[axis] - least[axis], size[axis] / 2.0f, 1e-6f * tree.extent) << "axis " << axis;
            EXPECT_NEAR(most[axis] - p[axis], size[axis] / 2.0f, 1e-6f * tree.extent) << "axis " << axis;
        }
    }
}

TEST(VarianceTarget, ProbabilityFollowsTheRootOfTheMoment) {
    const SdTree tree = even_tree(1);
    CellSums sums(0, 1, 4);
    sums.add_count(0, 10);
    for (std::uint32_t c = 0; c < 4; ++c)
        sums.add_quanta(c, std::uint64_t{1'000'000} * (c == 0 ? 16 : 1));
    RefineReport report;
    RefineSettings settings;
    settings.spatial_threshold = 1e9;
    settings.directional_divisor = 1;
    settings.target = GuidingTarget::variance;
    const SdTree next = refine(tree, sums, settings, report);
    ASSERT_EQ(next.cell_count(), 4u);
    EXPECT_NEAR(next.cell_mass[0] / double(1u << kMassBits), 4.0 / 7.0, 1e-4);
    EXPECT_NEAR(next.cell_mass[1] / double(1u << kMassBits), 1.0 / 7.0, 1e-4);
}

TEST(VarianceTarget, SmallCellsNeedTheirArea) {
    // Equal moments in cells of unequal area: sqrt(moment * area).
    SdTree tree = even_tree(1);
    tree.cell_depth = {1, 1, 1, 2, 2, 2, 2};
    tree.cell_begin = {0, 7};
    tree.cell_mass.assign(7, (1u << kMassBits) / 7);
    tree.cell_mass[0] += (1u << kMassBits) % 7;
    CellSums sums(0, 1, 7);
    for (std::uint32_t c = 0; c < 7; ++c)
        sums.add_quanta(c, 1'000'000);
    RefineReport report;
    RefineSettings settings;
    settings.spatial_threshold = 1e9;
    settings.directional_divisor = 8;
    settings.target = GuidingTarget::variance;
    const SdTree next = refine(tree, sums, settings, report);
    const auto density = [&](std::uint32_t c) { return next.cell_mass[c] * std::ldexp(1.0, 2 * next.cell_depth[c]); };
    EXPECT_NEAR(density(next.cell_count() - 1) / density(0), 2.0, 1e-3);
}

}  // namespace
}  // namespace treefarm
