// SPDX-License-Identifier: Apache-2.0
// Renders of many passes keep few images, and lose nothing of what they know.
#include "common/film/fold_passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/film/error_estimate.h"

namespace treefarm {
namespace {

constexpr std::size_t kPixelCount = 256;

PassResult make_pass(std::uint32_t spp, std::uint32_t before, double deviation, std::mt19937& engine,
                     std::size_t pixels = kPixelCount) {
    std::exponential_distribution<double> value;  // skewed: its variance says something of its mean
    PassResult pass{spp, before, std::vector<PixelEstimate>(pixels)};
    for (PixelEstimate& pixel : pass.pixels)
        for (std::uint32_t s = 0; s < spp; ++s)
            pixel.add(before + s, Rgb(static_cast<float>(1 + deviation * (value(engine) - 1))));
    return pass;
}

/// Passes as they come, with what says which are alike.
struct Kind {
    std::uint32_t spp;
    bool same_tree = false, new_technique = false;
    double deviation = 1;
};

struct Folded {
    std::vector<PassResult> few, all;
};

Folded render(const std::vector<Kind>& kinds, unsigned seed, std::size_t pixels = kPixelCount) {
    std::mt19937 engine(seed);
    Folded passes;
    std::uint32_t before = 0;
    for (const Kind& kind : kinds) {
        PassResult pass = make_pass(kind.spp, before, kind.deviation, engine, pixels);
        pass.same_tree = kind.same_tree;
        pass.new_technique = kind.new_technique;
        before += kind.spp;
        passes.all.push_back(pass);
        passes.few.push_back(std::move(pass));
        fold_passes(passes.few);
        remember_noise(passes.few, Combination::inverse_variance, true);
    }
    return passes;
}

std::vector<Kind> equal(std::size_t count, std::uint32_t spp, bool same_tree) {
    std::vector<Kind> kinds(count, Kind{spp, same_tree});
    kinds.front().same_tree = false;
    return kinds;
}

TEST(FoldPasses, KeepsEightImagesOfTwoHundredPasses) {
    const Folded passes = render(equal(200, 2, false), 1, 4);
    EXPECT_EQ(passes.few.size(), kMostPassImages);
    std::uint32_t spp = 0, before = 0;
    for (const PassResult& pass : passes.few) {
        EXPECT_EQ(pass.spp_before, before);
        for (const PixelEstimate& pixel : pass.pixels)
            EXPECT_EQ(pixel.whole().n, pass.spp);
        before += pass.spp;
        spp += pass.spp;
    }
    EXPECT_EQ(spp, 400u);
    EXPECT_TRUE(passes.few.back().parts.empty()) << "the last pass has figures of its own";
    EXPECT_EQ(combine_passes(passes.few, Combination::inverse_variance, true).weight.size(), 200u);
}

TEST(FoldPasses, EightPassesStayAsTheyAre) {
    const Folded passes = render(equal(8, 4, false), 2);
    for (std::size_t k = 0; k < 8; ++k)
        EXPECT_TRUE(passes.few[k].parts.empty());
    for (const Combination method : {Combination::inverse_variance, Combination::fixed, Combination::last})
        EXPECT_EQ(combine_passes(passes.few, method, true).mean, combine_passes(passes.all, method, true).mean);
}

TEST(FoldPasses, AlikeNeighboursGoFirstAndTechniquesLast) {
    const auto pair = [](const std::vector<Kind>& kinds) {
        std::vector<PassResult> passes;
        for (const Kind& kind : kinds) {
            PassResult pass{.spp = kind.spp, .pixels = {}};
            pass.same_tree = kind.same_tree;
            pass.new_technique = kind.new_technique;
            passes.push_back(std::move(pass));
        }
        return pair_to_fold(passes);
    };
    EXPECT_EQ(pair({{1}, {2}, {4}, {8}}), 0u);
    EXPECT_EQ(pair({{4}, {4}, {4}, {4}}), 0u) << "the older ones";
    EXPECT_EQ(pair({{8}, {4}, {4}, {4}}), 1u) << "the shorter ones";
    EXPECT_EQ(pair({{1}, {2}, {64}, {64, true}, {64, true}}), 2u);
    EXPECT_EQ(pair({{1}, {2}, {64}, {64, true}}), 0u) << "never the last";
    EXPECT_EQ(pair({{1}, {2, false, true}, {64}, {64}}), 1u);
    EXPECT_EQ(pair({{1}, {2, false, true}, {64, true, true}, {64}}), 0u) << "where there is nothing else";
}

/// Equal up to rounding: passes of one tree are one pass that was cut.
TEST(FoldPasses, OfAlikePassesNothingIsLost) {
    std::vector<Kind> kinds{{4, false, false, 3.0}, {8, false, false, 2.0}};
    for (int k = 0; k < 20; ++k)
        kinds.push_back({8, k > 0, false, 1.0});
    const Folded passes = render(kinds, 3);
    ASSERT_EQ(passes.few.size(), kMostPassImages);
    EXPECT_EQ(passes.few[0].spp, 4u);
    EXPECT_EQ(passes.few[1].spp, 8u);
    for (const bool guided : {true, false})
        for (const Combination method : {Combination::inverse_variance, Combination::last}) {
            const CombinedImage few = combine_passes(passes.few, method, guided),
                                all = combine_passes(passes.all, method, guided);
            ASSERT_EQ(few.weight.size(), all.weight.size());
            // A half of a pass knows its mean less well than that of many: the difference is in the noise by which
            // trees are weighed, a few percent here, and the last tree has nearly all the weight.
            for (std::size_t k = 0; k < all.weight.size(); ++k)
                EXPECT_NEAR(few.weight[k], all.weight[k], guided ? 1e-3 : 1e-12) << k;
            for (std::size_t p = 0; p < kPixelCount; ++p)
                EXPECT_NEAR(few.mean[p].x, all.mean[p].x, guided && method != Combination::last ? 0.02 : 1e-12);
        }
}

TEST(FoldPasses, FixedWeightsStayTheSumOfTheirPasses) {
    const Folded passes = render(equal(30, 4, false), 4);
    const CombinedImage few = combine_passes(passes.few, Combination::fixed, true);
    double all = 0, last = 0, sum = 0;
    for (std::uint32_t k = 0; k < 30; ++k)
        all += last = fixed_weight(4, 4 * k, true);
    EXPECT_NEAR(few.weight.back(), last / all, 1e-12);
    for (const double weight : few.weight)
        sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

/// The variance of an image whose passes were merged, whatever their trees, is what replicas show, and its mean the
/// truth.
TEST(FoldPasses, MeanIsUnbiasedAndVarianceRight) {
    for (const bool same_tree : {true, false})
        for (const Combination method : {Combination::inverse_variance, Combination::fixed}) {
            constexpr int kRuns = 120;
            double sum = 0, squares = 0, expected = 0, error = 0;
            for (unsigned run = 0; run < kRuns; ++run) {
                std::vector<Kind> kinds = equal(40, 2, same_tree);
                for (std::size_t k = 0; k < kinds.size(); ++k)
                    kinds[k].deviation = same_tree ? 1 : std::max(1.0, 3 - 0.1 * static_cast<double>(k));
                const CombinedImage image = combine_passes(render(kinds, 100 + run).few, method, true);
                double mean = 0;
                for (std::size_t p = 0; p < kPixelCount; ++p) {
                    mean += image.mean[p].x / kPixelCount;
                    expected += image.variance[p].x / (kPixelCount * kRuns);
                    error += (image.mean[p].x - 1) * (image.mean[p].x - 1) / (kPixelCount * kRuns);
                }
                sum += mean / kRuns;
                squares += mean * mean / kRuns;
            }
            const double deviation = std::sqrt((squares - sum * sum) / (kRuns - 1));
            // Known before: a pass of one sample in a half has no weight by its variance, merged it has. 30,720 pixels
            // of 80 skewed samples: the ratio is known to 1 %.
            EXPECT_LT(std::abs(sum - 1), 4 * deviation) << same_tree << int(method);
            EXPECT_NEAR(expected / error, 1.0, 0.06) << same_tree << int(method);
        }
}

}  // namespace
}  // namespace treefarm
