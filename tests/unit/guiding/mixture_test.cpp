// SPDX-License-Identifier: Apache-2.0
// The learned mixture of BSDF and tree, against optima found by hand or by search.
#include "common/guiding/regions/mixture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/error.h"
#include "common/base/policy.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/sd_tree.h"

namespace treefarm {
namespace {

MixtureHistogram only(int bin, double value = 1.0) {
    MixtureHistogram histogram{};
    histogram[static_cast<std::size_t>(bin)] = value;
    return histogram;
}

double objective(const MixtureHistogram& histogram, double prior, double weight, double a) {
    double sum = weight * (prior * std::log(a) + (1 - prior) * std::log(1 - a));
    for (int b = 0; b < kMixtureBins; ++b) {
        const double r = (b + 0.5) / kMixtureBins;
        sum += histogram[static_cast<std::size_t>(b)] * std::log(a * r + (1 - a) * (1 - r));
    }
    return sum;
}

TEST(Mixture, BinsCoverAllDensities) {
    EXPECT_EQ(mixture_bin(0.0f, 1.0f), 0);
    EXPECT_EQ(mixture_bin(1.0f, 1.0f), kMixtureBins / 2);
    EXPECT_EQ(mixture_bin(1.0f, 0.0f), kMixtureBins - 1);
    EXPECT_EQ(mixture_bin(0.0f, 0.0f), 0);
    EXPECT_EQ(mixture_bin(1e30f, 1e-30f), kMixtureBins - 1);
    EXPECT_EQ(mixture_bin(std::numeric_limits<float>::infinity(), 1.0f), 0) << "NaN must not leave the bins";
}

TEST(Mixture, FollowsWhatFitsBetter) {
    EXPECT_NEAR(best_bsdf_fraction(only(kMixtureBins - 1), 0.5, 0.0), 1.0, 1e-6);
    EXPECT_NEAR(best_bsdf_fraction(only(0), 0.5, 0.0), tuned("learning.least_bsdf_fraction"), 1e-6);
}

TEST(Mixture, WithoutDataKeepsThePrior) {
    EXPECT_NEAR(best_bsdf_fraction({}, 0.3, 1.0), 0.3, 1e-6);
    EXPECT_NEAR(best_bsdf_fraction(only(kMixtureBins - 1, 1e-6), 0.3, 1.0), 0.3, 1e-4);
}

TEST(Mixture, IsTheMaximumOfTheObjective) {
    MixtureHistogram histogram{};
    for (int b = 0; b < kMixtureBins; ++b)
        histogram[static_cast<std::size_t>(b)] = 1.0 + (b * 7 % 5);
    histogram[2] = 9;
    for (const double prior : {0.2, 0.5, 0.9}) {
        const double best = best_bsdf_fraction(histogram, prior, 3.0);
        for (double a = tuned("learning.least_bsdf_fraction"); a < 0.999; a += 0.001)
            EXPECT_GE(objective(histogram, prior, 3.0, best) + 1e-9, objective(histogram, prior, 3.0, a)) << a;
    }
}

class MixtureLearning : public ::testing::Test {
  protected:
    CellSums sums(const SdTree& tree, std::uint32_t region, std::uint8_t bin) const {
        CellSums s(tree.pass, tree.region_count(), tree.cell_count(), true);
        for (std::uint32_t r = 0; r < tree.region_count(); ++r) {
            s.add_count(r, 1000);
            for (const int even : {0, kMixtureBins - 1})
                s.add_mixture(r, r == region ? bin : static_cast<std::uint8_t>(even), 500 << 16);
        }
        return s;
    }

    SdTree next(const SdTree& tree, const CellSums& s, double threshold) {
        RefineReport report;
        SdTree refined = refine(tree, s, {.spatial_threshold = threshold}, report);
        learner_.learn(tree, s, report.origins, refined);
        return refined;
    }

    MixtureLearner learner_;
    SdTree root_ = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f, 0.5f);
};

TEST_F(MixtureLearning, PartsInheritFromTheWhole) {
    const SdTree split = next(root_, sums(root_, 0, kMixtureBins - 1), 300);
    ASSERT_EQ(split.region_count(), 4u);
    for (const float a : split.bsdf_fraction) {
        EXPECT_EQ(a, split.bsdf_fraction[0]);
        EXPECT_GT(a, 0.8f);
    }
    const SdTree after = next(split, sums(split, 2, 0), 1e9);
    EXPECT_LT(after.bsdf_fraction[2], 0.35f);
    EXPECT_GT(after.bsdf_fraction[1], 0.5f);
    EXPECT_LT(after.bsdf_fraction[1], split.bsdf_fraction[1]) << "new evidence counts more than the past";
}

TEST_F(MixtureLearning, RegionsWithoutRecordsKeepTheirFraction) {
    root_.bsdf_fraction = {0.25f};
    const CellSums nothing(0, 1, root_.cell_count(), true);
    EXPECT_EQ(next(root_, nothing, 1e9).bsdf_fraction[0], 0.25f);
}

TEST_F(MixtureLearning, RefusesSumsOfAnotherTree) {
    SdTree tree = root_;
    EXPECT_THROW(learner_.learn(root_, CellSums(0, 1, root_.cell_count()), {}, tree), RunError);
}

}  // namespace
}  // namespace treefarm
