// SPDX-License-Identifier: Apache-2.0
// What a view adds to the mixture of its region, and when it is released.
#include "common/guiding/sd_tree/view_mixture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "worker/guides/sd_tree_walk.h"

namespace treefarm {
namespace {

MixtureHistogram one_bin(int bin, double value = 1.0) {
    MixtureHistogram histogram{};
    histogram[static_cast<std::size_t>(bin)] = value;
    return histogram;
}

constexpr int kOthersBin = kMixtureBins - 1, kViewBin = 0;

TEST(ViewMixture, GainsNothingWhereT2IsOfNoUse) {
    EXPECT_LE(view_gain(one_bin(kOthersBin), 1.0), 0.0);
    EXPECT_LT(view_gain(one_bin(kOthersBin), 0.5), 0.0) << "what goes to the view is taken from what is needed";
    EXPECT_GT(view_gain(one_bin(kViewBin), 0.05), 3.0);
    EXPECT_EQ(view_gain({}, 0.5), 0.0);
}

TEST(ViewMixture, GainIsTheMeanLogarithmOfTheRatioOfDensities) {
    MixtureHistogram histogram{};
    histogram[3] = 2.0;
    histogram[12] = 6.0;
    const double r3 = 3.5 / kMixtureBins, r12 = 12.5 / kMixtureBins, a = 0.7;
    const double expected =
        (2 * std::log((a * r3 + 0.3 * (1 - r3)) / r3) + 6 * std::log((a * r12 + 0.3 * (1 - r12)) / r12)) / 8;
    EXPECT_NEAR(view_gain(histogram, a), expected, 1e-12);
}

/// A tree of one region and one view, as it is after the first pass.
struct OneView {
    SdTree tree;
    ViewLearner learner;

    OneView() {
        Box3 box{Vec3(0.0f)};
        box.extendBy(Vec3(1.0f));
        tree = initial_tree(box, {1.0f, 0.5f, true, 0.0f});
        tree.trained = true;
    }

    /// A pass in which `records` of the view, of `all`, fell into this bin. Whether the view is kept.
    bool judge(int bin, std::uint32_t records, std::uint32_t all, bool last_update = false) {
        CellSums sums(tree.pass, SumsShape(1, tree.cell_count(), true, 1));
        sums.add_count(0, all);
        sums.add_count(1, records);
        sums.add_mixture(1, static_cast<std::uint8_t>(bin), std::uint64_t{records} << kMeanRecordBits);
        const bool keep = learner.judge(tree, sums, last_update)[0].keep;
        const ViewOrigin same{0, 0};
        learner.set_fractions({&same, 1}, tree);
        return keep;
    }
};

TEST(ViewMixture, AYoungViewLeavesItsRegionAsItIs) {
    OneView one;
    EXPECT_EQ(one.tree.view_fraction[0], 0.0f);
    one.judge(kViewBin, 1, 10);
    EXPECT_LT(one.tree.view_fraction[0], 0.05f) << "64 records' worth of prior";
    for (int pass = 0; pass < 3; ++pass)
        one.judge(kViewBin, 10000, 20000);
    EXPECT_GT(one.tree.view_fraction[0], 0.9f);
    EXPECT_LE(one.tree.view_fraction[0], 1.0f - one.tree.bsdf_fraction[1]) << "the BSDF reaches everything";
    EXPECT_NO_THROW(decode_tree(encode_tree(one.tree)));
}

TEST(ViewMixture, OfNoUseTwiceItIsReleasedAndAtOnceInTheLastUpdate) {
    OneView useful, useless, last;
    EXPECT_TRUE(useful.judge(kViewBin, 10000, 20000));
    EXPECT_TRUE(useful.judge(kViewBin, 10000, 20000, true));
    EXPECT_TRUE(useless.judge(kOthersBin, 10000, 20000));
    EXPECT_FALSE(useless.judge(kOthersBin, 10000, 20000));
    EXPECT_FALSE(last.judge(kOthersBin, 10000, 20000, true));
}

/// All vertices pay for the view-dependent kernel: the good that a few do must outweigh that.
TEST(ViewMixture, OfUseToFewIsReleasedToo) {
    OneView one;
    one.judge(kViewBin, 1000, 10000000);
    EXPECT_FALSE(one.judge(kViewBin, 1000, 10000000));
}

TEST(ViewMixture, TakesItsPartOfWhatRegionAndBsdfShare) {
    const float region_fraction = 0.6f;
    using List = SdTreeWalk<true>::List;
    const List::Guidance guidance{{0, region_fraction * (1 - 0.25f)}, {1, 0.25f}};
    EXPECT_NEAR(List::pdf_before<0>(guidance, 2.0f, 3.0f, {7.0f}), mixed_pdf(region_fraction, 2.0f, 3.0f), 1e-6f);
    EXPECT_NEAR(List::mixed_pdf(guidance, 2.0f, 3.0f, {7.0f}),
                0.25f * 7 + 0.75f * mixed_pdf(region_fraction, 2.0f, 3.0f), 1e-6f);
}

}  // namespace
}  // namespace treefarm
