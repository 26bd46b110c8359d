// SPDX-License-Identifier: Apache-2.0
// Combining passes and the figures that are printed of each.
#include "common/film/combine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/film/error_estimate.h"

namespace treefarm {
namespace {

PassResult make_pass(std::uint32_t spp, std::uint32_t before, float mean, float deviation, std::size_t pixels,
                     unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<float> noise;
    PassResult pass{spp, before, std::vector<PixelEstimate>(pixels)};
    for (PixelEstimate& pixel : pass.pixels)
        for (std::uint32_t s = 0; s < spp; ++s)
            pixel.add(before + s, Rgb(mean + deviation * noise(engine)));
    return pass;
}

TEST(Combine, LastIsTheLastPass) {
    const std::vector<PassResult> passes{make_pass(4, 0, 1.0f, 0.0f, 3, 1), make_pass(8, 4, 2.0f, 0.0f, 3, 2)};
    const CombinedImage image = combine_passes(passes, Combination::last, true);
    for (const Rgb64& m : image.mean)
        EXPECT_DOUBLE_EQ(m.x, 2.0);
}

TEST(Combine, LastTakesAllPassesOfTheLastTree) {
    std::vector<PassResult> passes{make_pass(4, 0, 1.0f, 0.0f, 3, 1), make_pass(6, 4, 2.0f, 0.0f, 3, 2),
                                   make_pass(2, 10, 4.0f, 0.0f, 3, 3)};
    passes.back().same_tree = true;
    const CombinedImage image = combine_passes(passes, Combination::last, true);
    for (const Rgb64& m : image.mean)
        EXPECT_DOUBLE_EQ(m.x, (6 * 2.0 + 2 * 4.0) / 8) << "every sample weighs the same";
}

TEST(Combine, FixedWeightsGrowWithSamplesAndTraining) {
    const std::vector<PassResult> passes{make_pass(4, 0, 1.0f, 0.0f, 2, 1), make_pass(8, 4, 2.0f, 0.0f, 2, 2)};
    const CombinedImage image = combine_passes(passes, Combination::fixed, true);
    const double w0 = 4.0 * 1.0, w1 = 8.0 * 2.0;  // n_k sqrt(N_k), N_0 taken as 1
    EXPECT_NEAR(image.mean[0].y, (w0 * 1.0 + w1 * 2.0) / (w0 + w1), 1e-12);
}

TEST(Combine, WithoutGuidingEverySampleWeighsTheSame) {
    const std::vector<PassResult> passes{make_pass(4, 0, 1.0f, 0.0f, 2, 1), make_pass(12, 4, 2.0f, 0.0f, 2, 2)};
    for (const Combination method : {Combination::fixed, Combination::inverse_variance, Combination::last})
        EXPECT_NEAR(combine_passes(passes, method, false).mean[1].z, (4 * 1.0 + 12 * 2.0) / 16, 1e-12);
}

TEST(Combine, InverseVarianceFavoursTheQuietPass) {
    const std::vector<PassResult> passes{make_pass(16, 0, 1.0f, 1.0f, 2000, 1), make_pass(16, 16, 1.0f, 0.1f, 2000, 2)};
    const CombinedImage image = combine_passes(passes, Combination::inverse_variance, true);
    EXPECT_NEAR(image.weight[1], 100.0 / 101.0, 2e-3);
    // The image reports its own error: true variance of the mean is 1 / (16/1 + 16/0.01).
    const double rmse = estimate_error(image, 0).rmse;
    EXPECT_NEAR(rmse, std::sqrt(1.0 / (16.0 + 1600.0)), 0.05 * rmse);
    double squared = 0;
    for (const Rgb64& m : image.mean)
        squared += (m.x - 1.0) * (m.x - 1.0);
    EXPECT_NEAR(std::sqrt(squared / 2000), rmse, 0.1 * rmse);
}

TEST(Combine, EachHalfIsWeighedByTheOthersVariance) {
    // The even samples of the first pass are noisy, its odd ones quiet; in the second pass it is the other way round.
    std::vector<PassResult> passes;
    for (const float mean : {1.0f, 2.0f}) {
        PassResult pass{8, 8 * static_cast<std::uint32_t>(passes.size()), std::vector<PixelEstimate>(3)};
        for (PixelEstimate& pixel : pass.pixels)
            for (std::uint32_t s = 0; s < 8; ++s) {
                const bool noisy = (s % 2 == 0) == (mean == 1.0f);
                pixel.add(s, Rgb(mean + (s / 2 % 2 ? 1.0f : -1.0f) * (noisy ? 1.0f : 0.125f)));
            }
        passes.push_back(std::move(pass));
    }
    passes[1].new_technique = true;  // may be worse
    const CombinedImage image = combine_passes(passes, Combination::inverse_variance, true);
    EXPECT_NEAR(image.half[0][0].x, (64 * 1.0 + 1 * 2.0) / 65, 1e-9);  // the odd samples trust the first pass
    EXPECT_NEAR(image.half[1][0].x, (1 * 1.0 + 64 * 2.0) / 65, 1e-9);
    EXPECT_NEAR(image.mean[0].x, 1.5, 1e-9);
}

TEST(Combine, SamplesOfOneTreeWeighTheSame) {
    std::vector<PassResult> passes{make_pass(16, 0, 1.0f, 2.0f, 2000, 1), make_pass(8, 16, 1.0f, 0.5f, 2000, 2),
                                   make_pass(2, 24, 1.0f, 1.3f, 2000, 3), make_pass(22, 26, 1.0f, 1.3f, 2000, 4),
                                   make_pass(22, 48, 1.0f, 0.1f, 2000, 5)};
    passes[2].same_tree = passes[3].same_tree = passes[4].same_tree = true;
    passes[4].new_technique = true;  // next event has ended: nothing of it says how noisy the others are
    const std::vector<double> weight = combine_passes(passes, Combination::inverse_variance, true).weight;
    EXPECT_NEAR(weight[1] / weight[3], 8.0 / 22, 1e-9);
    EXPECT_NEAR(weight[2] / weight[3], 2.0 / 22, 1e-9) << "also of a pass that is too short to weigh itself";
    const double pooled = (3 * 0.25 + 10 * 1.69) / 13;  // by degrees of freedom of a half
    EXPECT_NEAR(weight[0] / (weight[1] + weight[2] + weight[3]), (16 / 4.0) / (32 / pooled), 0.01);
}

TEST(Combine, RememberedNoiseGivesTheSameImage) {
    std::vector<PassResult> kept;
    for (std::uint32_t k = 0; k < 4; ++k) {
        kept.push_back(make_pass(8u << k, 8 * ((1u << k) - 1), 1.0f, 2.0f / static_cast<float>(1 + k), 200, k));
        kept.back().same_tree = k == 3;  // joins passes whose noise is known already
        remember_noise(kept, Combination::inverse_variance, true);
        std::vector<PassResult> forgotten = kept;
        for (PassResult& pass : forgotten)
            pass.noise = {};
        const CombinedImage image = combine_passes(kept, Combination::inverse_variance, true);
        const CombinedImage again = combine_passes(forgotten, Combination::inverse_variance, true);
        EXPECT_EQ(image.weight, again.weight);
        EXPECT_EQ(image.mean, again.mean);
    }
    EXPECT_EQ(kept[2].noise.passes, 2u);
}

TEST(Combine, NoTreeIsTakenForWorseThanTheOneBefore) {
    // By its few samples the second pass is quieter than what comes after it.
    std::vector<PassResult> passes{make_pass(8, 0, 1.0f, 2.0f, 2000, 1), make_pass(8, 8, 1.0f, 0.25f, 2000, 2),
                                   make_pass(16, 16, 1.0f, 1.0f, 2000, 3), make_pass(32, 32, 1.0f, 0.5f, 2000, 4)};
    const auto weights = [&] { return combine_passes(passes, Combination::inverse_variance, true).weight; };
    EXPECT_NEAR(weights()[1] / weights()[2], 8.0 / 16, 1e-9);
    const double pooled = (8 * 0.0625 + 16 * 1.0) / 24;
    EXPECT_NEAR(weights()[0] / weights()[2], (8 / 4.0) / (16 / pooled), 0.01);
    EXPECT_NEAR(weights()[3] / weights()[2], (32 / 0.25) / (16 / pooled), 0.1);
    // Unless it was sampled in another way.
    passes[2].new_technique = true;
    EXPECT_NEAR(weights()[1] / weights()[2], (8 / 0.0625) / 16, 0.3);
}

TEST(Combine, YoungTreesCountOnlyWhereNoneIsBetter) {
    std::vector<PassResult> passes{make_pass(1, 0, 1.0f, 1.0f, 2000, 1), make_pass(2, 1, 1.0f, 1.0f, 2000, 2),
                                   make_pass(4, 3, 1.0f, 1.0f, 2000, 3), make_pass(16, 7, 1.0f, 1.0f, 2000, 4)};
    const auto image = [&] { return combine_passes(passes, Combination::inverse_variance, true); };
    EXPECT_EQ(image().weight[0] + image().weight[1], 0) << "later trees are better";
    passes[3].guided = false;  // guiding was given up after 4 spp
    passes[3].pixels = make_pass(16, 7, 1.0f, 1.1f, 2000, 4).pixels;
    const CombinedImage whole = image();
    EXPECT_NEAR(whole.weight[1] / whole.weight[2], 2.0 / 4, 0.01);
    EXPECT_NEAR(whole.weight[2] / whole.weight[3], 4.0 / 16, 0.01);
    EXPECT_NEAR(whole.weight[0] / whole.weight[3], 1.0 / 16, 0.01) << "though but one half holds its sample";
    const double rmse = estimate_error(whole, 0).rmse;
    EXPECT_NEAR(rmse, std::sqrt((7 + 16 * 1.21) / (23.0 * 23)), 0.05 * rmse);
    passes.push_back(make_pass(2, 23, 1.0f, 1.0f, 2000, 5));
    passes.back().guided = false;
    EXPECT_NEAR(image().weight[4] / image().weight[3], 2.0 / 16, 0.01) << "nor is what comes last thrown away";
}

TEST(Combine, ARareSampleTakesNoWeightFromItsPass) {
    std::vector<PassResult> passes{make_pass(16, 0, 1.0f, 1.0f, 2000, 1), make_pass(16, 16, 1.0f, 1.0f, 2000, 2)};
    passes[0].pixels[7].add(16, Rgb(1e5f));
    const CombinedImage image = combine_passes(passes, Combination::inverse_variance, true);
    EXPECT_NEAR(image.weight[0], 0.5, 0.02);
}

TEST(Combine, IsUnbiasedWhenVarianceFollowsTheSignal) {
    // Skewed samples: a weight per pixel would pull the mean down.
    double sum = 0, squared = 0;
    constexpr int kRuns = 400;
    for (unsigned run = 0; run < kRuns; ++run) {
        std::mt19937 engine(run);
        std::vector<PassResult> passes;
        for (const std::uint32_t spp : {8u, 16u}) {
            PassResult pass{spp, spp - 8, std::vector<PixelEstimate>(64)};
            std::exponential_distribution<float> value(1.0f);
            for (PixelEstimate& pixel : pass.pixels)
                for (std::uint32_t s = 0; s < spp; ++s)
                    pixel.add(s, Rgb(value(engine)));
            passes.push_back(std::move(pass));
        }
        double mean = 0;
        for (const Rgb64& m : combine_passes(passes, Combination::inverse_variance, true).mean)
            mean += m.x / 64;
        sum += mean;
        squared += mean * mean;
    }
    const double mean = sum / kRuns;
    const double error = std::sqrt((squared / kRuns - mean * mean) / kRuns);
    EXPECT_NEAR(mean, 1.0, 4 * error);
    EXPECT_LT(error, 0.005);
}

TEST(Combine, PassesOfOneSampleJoinNoHalf) {
    const std::vector<PassResult> passes{make_pass(1, 0, 5.0f, 0.0f, 2, 1), make_pass(8, 1, 2.0f, 1e-3f, 2, 2)};
    const CombinedImage image = combine_passes(passes, Combination::inverse_variance, true);
    EXPECT_EQ(image.weight[0], 0.0);
    EXPECT_NEAR(image.mean[0].x, 2.0, 0.01);
    const CombinedImage alone = combine_passes(std::span(passes).first(1), Combination::inverse_variance, true);
    EXPECT_DOUBLE_EQ(alone.mean[0].x, 5.0);
}

TEST(PassVariance, MatchesHandComputedValues) {
    PixelEstimate pixel;
    for (std::uint32_t s = 0; s < 4; ++s)
        pixel.add(s, Rgb(s < 2 ? 0.0f : 2.0f));
    const PassVariance v = pass_variance(std::vector<PixelEstimate>{pixel});
    EXPECT_NEAR(v.stuv, 4.0 / 3.0, 1e-6);  // deviations 1, 1, 1, 1 over n - 1 = 3
    // n lum(m2 - m1^2 / n) / (n - 1) with m1 = 1, m2 = 2: 4 (2 - 1/4) / 3
    EXPECT_NEAR(v.stuv_ppg, 4 * 1.75 / 3.0, 1e-6);
}

TEST(PassVariance, TrimsTheWorstThousandth) {
    std::vector<PixelEstimate> pixels(2000);
    for (std::size_t p = 0; p < pixels.size(); ++p)
        for (std::uint32_t s = 0; s < 2; ++s)
            pixels[p].add(s, Rgb(p < 2 && s == 0 ? 1000.0f : static_cast<float>(s)));
    const PassVariance v = pass_variance(pixels);
    EXPECT_NEAR(v.stuv_trimmed, 0.5, 1e-6);
    EXPECT_GT(v.stuv, 100.0);
}

}  // namespace
}  // namespace treefarm
