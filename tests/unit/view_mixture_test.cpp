// The learned mixture of BSDF, T1 and T2, against optima found by search.
#include "common/guiding/view_mixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/guiding/mixture.h"

namespace treefarm {
namespace {

ViewMixtureHistogram only(int bin, double value = 1.0) {
    ViewMixtureHistogram histogram{};
    histogram[static_cast<std::size_t>(bin)] = value;
    return histogram;
}

constexpr int kBsdfBin = kViewMixtureBins - 1, kTreeBin = 0, kViewBin = kViewSteps - 1;

double objective(const ViewMixtureHistogram& histogram, const ViewFractions& prior, double weight, double bsdf,
                 double view) {
    const double tree = 1 - bsdf - view;
    double sum = weight * (prior.bsdf * std::log(bsdf) + prior.tree * std::log(tree) + prior.view * std::log(view));
    for (int b = 0; b < kViewMixtureBins; ++b) {
        const double r = (b / kViewSteps + 0.5) / kBsdfSteps, share = (b % kViewSteps + 0.5) / kViewSteps;
        sum += histogram[static_cast<std::size_t>(b)] *
               std::log(bsdf * r + tree * (1 - r) * (1 - share) + view * (1 - r) * share);
    }
    return sum;
}

TEST(ViewMixture, BinsCoverAllDensities) {
    EXPECT_EQ(view_mixture_bin(1.0f, 0.0f, 0.0f), kBsdfBin - kViewSteps + 1);
    EXPECT_EQ(view_mixture_bin(0.0f, 1.0f, 0.0f), kTreeBin);
    EXPECT_EQ(view_mixture_bin(0.0f, 0.0f, 1.0f), kViewBin);
    EXPECT_EQ(view_mixture_bin(1e30f, 1e-30f, 1e-30f), kBsdfBin - 1) << "two halves of what is hardly there";
    EXPECT_EQ(view_mixture_bin(0.0f, 0.0f, 0.0f), 0) << "NaN must not leave the bins";
    EXPECT_LT(view_mixture_bin(std::numeric_limits<float>::infinity(), 1.0f, 1.0f), kViewMixtureBins);
}

TEST(ViewMixture, FollowsWhatFitsBetter) {
    const ViewFractions even{1.0 / 3, 1.0 / 3, 1.0 / 3};
    EXPECT_GT(best_view_fractions(only(kBsdfBin), even, 0.0).bsdf, 0.99);
    EXPECT_GT(best_view_fractions(only(kTreeBin), even, 0.0).tree, 0.94);
    EXPECT_GT(best_view_fractions(only(kViewBin), even, 0.0).view, 0.94);
    EXPECT_EQ(best_view_fractions(only(kViewBin), even, 0.0).bsdf, kLeastBsdfFraction) << "the BSDF reaches everything";
}

TEST(ViewMixture, WithoutDataKeepsThePrior) {
    const ViewFractions prior{0.4, 0.5, 0.1};
    for (const ViewMixtureHistogram& histogram : {ViewMixtureHistogram{}, only(kViewBin, 1e-9)}) {
        const ViewFractions a = best_view_fractions(histogram, prior, 1.0);
        EXPECT_NEAR(a.bsdf, 0.4, 1e-6);
        EXPECT_NEAR(a.tree, 0.5, 1e-6);
        EXPECT_NEAR(a.view, 0.1, 1e-6);
    }
}

TEST(ViewMixture, IsTheMaximumOfTheObjective) {
    std::mt19937 engine(3);
    std::exponential_distribution<double> exponential;
    for (int run = 0; run < 5; ++run) {
        ViewMixtureHistogram histogram;
        for (double& h : histogram)
            h = exponential(engine);
        const ViewFractions prior{0.3, 0.5, 0.2};
        const ViewFractions best = best_view_fractions(histogram, prior, 2.0);
        EXPECT_NEAR(best.bsdf + best.tree + best.view, 1.0, 1e-12);
        const double reached = objective(histogram, prior, 2.0, best.bsdf, best.view);
        for (double bsdf = 0.05; bsdf < 1; bsdf += 0.01)
            for (double view = 0.01; bsdf + view < 0.995; view += 0.01)
                ASSERT_GE(reached + 2e-3, objective(histogram, prior, 2.0, bsdf, view)) << bsdf << ' ' << view;
    }
}

TEST(ViewMixture, GainsNothingWhereT2IsOfNoUse) {
    const ViewMixtureHistogram useless = only(kTreeBin);
    EXPECT_LE(view_gain(useless, best_view_fractions(useless, {}, 1e-3)), 1e-3);
    const ViewMixtureHistogram useful = only(kViewBin);
    EXPECT_GT(view_gain(useful, best_view_fractions(useful, {}, 1e-3)), 1.0);
    EXPECT_EQ(view_gain({}, {}), 0.0);
}

}  // namespace
}  // namespace treefarm
