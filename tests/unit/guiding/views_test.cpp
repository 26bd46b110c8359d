// SPDX-License-Identifier: Apache-2.0
// T2, the view-dependent part of the tree: looked up, refined, encoded.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/base/error.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

class ViewsTest : public ::testing::Test {
  protected:
    SdTree tree = test::random_view_tree(5, 60000, 1500, 4000, 2);
    SdTreeSampler guide{tree};
    std::mt19937 engine{5};

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine()); }
};

TEST_F(ViewsTest, TheTestTreeIsInteresting) {
    EXPECT_GT(tree.region_count(), 20u);
    EXPECT_GT(tree.view_set_count(), 4u);
    EXPECT_LT(tree.view_set_count(), tree.region_count()) << "some share";
    EXPECT_GT(tree.view_count(), 2 * tree.view_set_count());
    EXPECT_EQ(guide.view_count(), tree.view_count());
}

TEST_F(ViewsTest, FindsTheViewThatHoldsADirection) {
    for (std::uint32_t r = 0; r < tree.region_count(); ++r) {
        const std::uint32_t set = tree.view_set[r];
        if (set == SdTree::kNoViews) {
            EXPECT_EQ(guide.view(r, bits()), SdTreeSampler::kNoView);
            continue;
        }
        std::uint64_t code = 0;
        for (std::uint32_t v = tree.view_begin[set]; v < tree.view_begin[set + 1]; ++v) {
            const std::uint64_t size = std::uint64_t{1} << (2 * (kDirectionBits - tree.view_depth[v]));
            EXPECT_EQ(guide.view(r, static_cast<std::uint32_t>(code)), tree.region_count() + v);
            EXPECT_EQ(guide.view(r, static_cast<std::uint32_t>(code + size - 1)), tree.region_count() + v);
            code += size;
        }
    }
}

TEST_F(ViewsTest, ViewsAreSampledByTheDensityOfTheirCells) {
    for (std::uint32_t v = 0; v < tree.view_count(); ++v) {
        const std::uint32_t d = tree.region_count() + v;
        double whole = 0;
        std::uint64_t code = 0;
        for (std::uint32_t c = tree.cell_begin[d]; c < tree.cell_begin[d + 1]; ++c) {
            const std::uint64_t size = std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
            EXPECT_EQ(guide.cell(d, static_cast<std::uint32_t>(code)), c);
            EXPECT_EQ(guide.cell(d, static_cast<std::uint32_t>(code + size - 1)), c);
            const double area = 4 * 3.14159265358979 / std::pow(4.0, tree.cell_depth[c]);
            whole += area * static_cast<double>(guide.pdf(d, static_cast<std::uint32_t>(code)));
            code += size;
        }
        EXPECT_NEAR(whole, 1.0, 1e-5);
        for (int i = 0; i < 20; ++i) {
            const SdTreeSampler::SquareSample drawn = guide.sample_square(d, bits(), bits(), bits());
            EXPECT_GT(drawn.pdf, 0.0f);
            EXPECT_EQ(drawn.pdf, guide.pdf(d, drawn.code));
        }
    }
}

TEST_F(ViewsTest, APickFindsTheCellThatHoldsItsProbability) {
    std::uint32_t largest = 0;
    for (std::uint32_t d = 0; d < tree.distribution_count(); ++d) {
        std::uint32_t mass = 0;
        for (std::uint32_t c = tree.cell_begin[d]; c < tree.cell_begin[d + 1]; mass += tree.cell_mass[c++]) {
            if (tree.cell_mass[c] == 0) continue;
            for (const std::uint32_t at : {mass, mass + tree.cell_mass[c] - 1}) {
                const SdTreeSampler::SquareSample drawn =
                    guide.sample_square(d, at << (32 - kMassBits), bits(), bits());
                ASSERT_EQ(guide.cell(d, drawn.code), c);
            }
        }
        if (d >= tree.region_count()) largest = std::max(largest, tree.cell_begin[d + 1] - tree.cell_begin[d]);
    }
    EXPECT_GT(largest, 64u) << "views that are searched between entries of their tables";
}

TEST_F(ViewsTest, SurviveTheCodec) {
    const SdTree decoded = decode_tree(encode_tree(tree));
    EXPECT_EQ(decoded.view_set, tree.view_set);
    EXPECT_EQ(decoded.view_begin, tree.view_begin);
    EXPECT_EQ(decoded.view_depth, tree.view_depth);
    EXPECT_EQ(decoded.view_fraction, tree.view_fraction);
    EXPECT_EQ(decoded.cell_begin, tree.cell_begin);
    EXPECT_EQ(decoded.bsdf_fraction, tree.bsdf_fraction);
    EXPECT_EQ(decoded.quantum_exponent, tree.quantum_exponent);
}

TEST_F(ViewsTest, BrokenViewsAreRefused) {
    const auto refuses = [&](auto&& damage) {
        SdTree broken = tree;
        damage(broken);
        EXPECT_THROW(decode_tree(encode_tree(broken)), FormatError);
    };
    refuses([](SdTree& t) { t.view_depth[0] = kMaxViewDepth + 1; });
    refuses([](SdTree& t) { t.view_depth.back() += 1; });
    refuses([](SdTree& t) { t.view_fraction[1] = 1.5f; });
    refuses([](SdTree& t) { t.view_fraction[1] = -0.1f; });
    refuses([](SdTree& t) { t.view_fraction[1] = std::nanf(""); });
    refuses([](SdTree& t) { t.view_fraction.pop_back(); });
    refuses([](SdTree& t) { t.view_set.back() += 7; });
    refuses([](SdTree& t) { t.view_set.front() = 1; });
    refuses([](SdTree& t) { t.view_set.assign(t.view_set.size(), SdTree::kNoViews); });
}

TEST_F(ViewsTest, SumsOfPartsAreTheSumOfTheWhole) {
    const std::vector<Record> records = test::random_view_records(guide, 20000, 9);
    const auto sums_of = [&](std::span<const Record> part) { return test::sums_of(guide, part); };
    CellSums merged(tree.pass, sums_of({}).shape());
    for (std::size_t at = 0; at < records.size(); at += 5000)
        merged.merge_encoded(sums_of(std::span(records).subspan(at, 5000)).encode());
    EXPECT_EQ(merged, sums_of(records));
    CellSums other(tree.pass, tree.distribution_count(), tree.cell_count());
    EXPECT_THROW(other.merge_encoded(CellSums(tree.pass, tree.region_count(), tree.cell_count()).encode()),
                 FormatError);
}

class RefineViews : public ::testing::Test {
  protected:
    SdTree root = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), {1.0f, 0.5f, true, 0.25f});
    RefineReport report;

    SdTree refined(const SdTree& tree, std::uint64_t region_records, std::uint64_t view_records,
                   RefineSettings settings, std::span<const ViewAdvice> advice = {}) {
        CellSums sums(tree.pass, {tree.region_count(), tree.cell_count(), false, tree.view_count()});
        for (std::uint32_t r = 0; r < tree.region_count(); ++r)
            sums.add_count(r, region_records);
        for (std::uint32_t v = 0; v < tree.view_count(); ++v)
            sums.add_count(tree.region_count() + v, view_records);
        for (std::uint32_t c = 0; c < tree.cell_count(); ++c)
            sums.add_quanta(c, 1 + c % 7);
        return refine(tree, sums, settings, report, advice);
    }
};

TEST_F(RefineViews, AsPublishedEveryRegionHasAT2OfItsOwnAndViewsSplitOnce) {
    const RefineSettings settings{
        .spatial_threshold = 1000, .view_threshold = 100, .view_set_threshold = 0, .views_record_alone = true};
    const SdTree next = refined(root, 1000, 3000, settings);  // 4000 together
    EXPECT_EQ(next.region_count(), 4u);
    EXPECT_EQ(next.view_set, (std::vector<std::uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(next.view_depth, std::vector<std::uint8_t>(16, 1)) << "once, however many records";
    EXPECT_EQ(report.view_origins.size(), 16u);
    EXPECT_EQ(report.view_origins[0].halvings, 2 + 2);
    const SdTree after = refined(next, 0, 101, settings);
    EXPECT_EQ(after.view_depth, std::vector<std::uint8_t>(64, 2));
    EXPECT_EQ(after.view_fraction, std::vector<float>(64, 0.25f));
}

TEST_F(RefineViews, ARegionWithoutRecordsOfViewsLosesItsT2) {
    const SdTree next = refined(root, 4000, 0, {.spatial_threshold = 1000});
    EXPECT_EQ(next.view_count(), 0u);
    EXPECT_TRUE(next.view_set.empty());
    EXPECT_EQ(next.distribution_count(), next.region_count());
}

TEST_F(RefineViews, RegionsShareAT2UntilItHasTheRecordsForTwo) {
    RefineSettings settings{.spatial_threshold = 1000, .view_threshold = 1e9, .view_set_threshold = 4000};
    EXPECT_EQ(refined(root, 4000, 4000, settings).view_set, (std::vector<std::uint32_t>{0, 0, 0, 0}));
    EXPECT_EQ(refined(root, 4000, 4001, settings).view_set, (std::vector<std::uint32_t>{0, 0, 1, 1}));
    settings.record_weight = 0.5;
    EXPECT_EQ(refined(root, 4000, 8000, settings).view_set, (std::vector<std::uint32_t>{0, 0}));
}

TEST_F(RefineViews, CellsStayWithinTheirBound) {
    for (const double bound : {0.1, 0.5, 1.0, 3.0}) {
        const SdTree next =
            refined(root, 64000, 64000, {.spatial_threshold = 1000, .view_threshold = 10, .view_cells = bound});
        const std::uint32_t of_regions = next.cell_begin[next.region_count()];
        EXPECT_LE(next.cell_count() - of_regions, bound * of_regions);
        EXPECT_GT(next.view_set_count(), bound) << "as many parts as there is room for";
    }
}

TEST_F(RefineViews, AdviceReleasesAndChoosesWhatSplits) {
    const RefineSettings settings{.spatial_threshold = 1e9, .view_threshold = 10, .view_set_threshold = 1e9};
    const SdTree four = refined(root, 100, 100, settings);
    ASSERT_EQ(four.view_count(), 4u);
    const std::vector<ViewAdvice> idle(4, {0.0, false});
    EXPECT_EQ(refined(four, 100, 100, settings, idle).view_count(), 0u);
    const std::vector<ViewAdvice> one = {{0.0, false}, {0.0, false}, {5.0, true}, {0.0, false}};
    EXPECT_EQ(refined(four, 100, 100, settings, one).view_depth, (std::vector<std::uint8_t>{1, 1, 2, 2, 2, 2, 1}));
    RefineSettings tight = settings;
    const SdTree whole = refined(four, 100, 100, settings, one);
    tight.view_cells = (static_cast<double>(whole.cell_count() - whole.cell_begin[1]) - 1) / whole.cell_begin[1];
    EXPECT_EQ(refined(four, 100, 100, tight, one).view_count(), 4u) << "no room for the split";
    EXPECT_EQ(report.views_capped, 1u);
}

}  // namespace
}  // namespace treefarm
