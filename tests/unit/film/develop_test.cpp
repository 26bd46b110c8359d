// SPDX-License-Identifier: Apache-2.0
// Layers of a pass become pixel estimates: means are those of the image, variances what replicas show.
#include "common/film/develop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/film/combine.h"
#include "common/film/error_estimate.h"
#include "tests/support/fake_work.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kWidth = 16, kPixels = kWidth * kWidth;

PassPlan light_pass(std::uint32_t paths) {
    PassPlan plan{.index = 0, .spp = paths};
    plan.units = {.tiles = false, .light_paths = paths};
    plan.layers = {.estimates = false, .splats = {kPixels, splat_exponent(0.8)}};
    return plan;
}

std::vector<PixelEstimate> replica(const PassPlan& plan, std::uint64_t seed) {
    UnitOutput output;
    output.splats.begin(plan.layers.splats);
    WorkUnit all{.kind = UnitKind::light_paths};
    all.count = plan.units.light_paths * kPixels;
    test::fake_light_paths(seed, plan, all, output);
    SplatSums sums(plan.layers.splats);
    sums.add(output.splats.summed(), output.splats.caps());
    return develop({}, sums, plan.splatting_paths());
}

/// Batch means: splats of a chain depend on each other, and the variance says so.
TEST(Develop, VariancesOfChainsAreThoseOfReplicas) {
    constexpr int kReplicas = 400;
    constexpr std::uint32_t kFewPixels = 4, kChains = 64;
    PassPlan plan{.index = 0, .spp = 3200};
    plan.units = {.tiles = false, .chains = kChains};
    plan.layers = {.estimates = false, .splats = {kFewPixels, splat_exponent(0.8), true}};
    WorkUnit all{.kind = UnitKind::chains};
    all.count = kChains;
    double sum = 0, squares = 0, expected = 0;
    for (std::uint64_t r = 0; r < kReplicas; ++r) {
        UnitOutput output;
        output.splats.begin(plan.layers.splats);
        test::fake_chains(100 + r, plan, all, output);
        SplatSums sums(plan.layers.splats);
        sums.add(output.splats.summed(), output.splats.caps());
        for (const PixelEstimate& pixel : develop({}, sums, plan.splatting_paths(), plan.splatting_chains()))
            for (const Moments& half : pixel.half) {
                const double n = half.n, mean = half.mean.y;
                sum += mean;
                squares += mean * mean;
                expected += half.m2.y / (n * (n - 1));
            }
    }
    constexpr double kValues = 2.0 * kFewPixels * kReplicas;
    const double variance = squares / kValues - (sum / kValues) * (sum / kValues);
    EXPECT_NEAR(sum / kValues, 1.0, 4 * std::sqrt(variance / kValues));
    EXPECT_NEAR(expected / kValues / variance, 1.0, 0.15);
    EXPECT_GT(variance, 10 * 0.75 / 1600) << "far from that of independent splats, 0.75 / n";
}

TEST(Develop, AHalfWithoutTwoChainsDoesNotCount) {
    const SplatSums sums(SplatShape{2, 0, true});
    const std::vector<PixelEstimate> pixels = develop({}, sums, {8, 8}, half_counts(0, 3));
    EXPECT_EQ(pixels[0].half[0].n, 8u);
    EXPECT_EQ(pixels[0].half[1].n, 0u);
}

TEST(Develop, WithoutSplatsEstimatesStayAsTheyAre) {
    std::vector<PixelEstimate> pixels(5);
    pixels[3].add(0, Rgb(2.0f));
    const PixelEstimate* const there = pixels.data();
    const std::vector<PixelEstimate> developed = develop(std::move(pixels), {}, {1, 0});
    EXPECT_EQ(developed.data(), there);
    EXPECT_EQ(developed[3].half[0].mean, Rgb64(2.0));
    EXPECT_EQ(developed[3].half[1].n, 0u);
}

TEST(Develop, HalvesAreEvenAndOddNumbers) {
    EXPECT_EQ(half_counts(0, 4), (HalfCounts{2, 2}));
    EXPECT_EQ(half_counts(0, 5), (HalfCounts{3, 2}));
    EXPECT_EQ(half_counts(1, 5), (HalfCounts{2, 3}));
    EXPECT_EQ(half_counts(7, 1), (HalfCounts{0, 1}));
}

/// Per pixel and channel over replicas: the mean is the image, and variances are right though a pixel gets few splats.
TEST(Develop, MeansAreTheImageAndVariancesThoseOfReplicas) {
    constexpr int kReplicas = 300;
    const PassPlan plan = light_pass(8);
    std::vector<Rgb64> sum(kPixels, Rgb64(0.0)), squares(kPixels, Rgb64(0.0));
    double expected = 0, expected_whole = 0;
    for (int r = 0; r < kReplicas; ++r) {
        const std::vector<PixelEstimate> pixels = replica(plan, 100 + static_cast<std::uint64_t>(r));
        for (std::uint32_t p = 0; p < kPixels; ++p) {
            const Moments whole = pixels[p].whole();
            ASSERT_EQ(whole.n, 8u);
            sum[p] += whole.mean;
            squares[p] += whole.mean * whole.mean;
            expected_whole += whole.sample_variance().y / 8 / kReplicas;
            for (const Moments& half : pixels[p].half)
                expected += half.sample_variance().y / half.n / 4 / kReplicas;
        }
    }
    double observed = 0, chi_square = 0;
    for (std::uint32_t p = 0; p < kPixels; ++p) {
        const Rgb truth = test::splatted_radiance(p);
        for (int c = 0; c < 3; ++c) {
            const double mean = sum[p][c] / kReplicas;
            const double variance = (squares[p][c] / kReplicas - mean * mean) * kReplicas / (kReplicas - 1);
            if (c == 1) observed += variance;
            if (c == 1) chi_square += (mean - 1) * (mean - 1) / (variance / kReplicas);
            EXPECT_NEAR(mean, static_cast<double>(truth[c]), 5 * std::sqrt(variance / kReplicas) + 1e-12) << p;
        }
    }
    EXPECT_NEAR(chi_square, kPixels, 4 * std::sqrt(2.0 * kPixels));
    // 76,800 means of some 20 splats each: their variance is known to 0.6 %.
    EXPECT_NEAR(expected / observed, 1.0, 0.025);
    EXPECT_NEAR(expected_whole / observed, 1.0, 0.025) << "also to those that know nothing of halves";
}

/// The error that a render tells of itself needs no branch for splats.
TEST(Develop, ErrorOfDevelopedPassesIsTheTrueOne) {
    double estimated = 0, truth = 0;
    int covered = 0;
    constexpr int kRuns = 60;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
        std::vector<PassResult> passes;
        std::uint32_t before = 0;
        for (const std::uint32_t paths : {4u, 8u, 16u}) {
            PassPlan plan = light_pass(paths);
            plan.first_sample = plan.units.first_light_path = before;
            passes.push_back({paths, before, replica(plan, 1000 + run)});
            before += paths;
        }
        const CombinedImage image = combine_passes(passes, Combination::inverse_variance, false);
        const ErrorEstimate error = estimate_error(image, run);
        double mse = 0;
        for (std::uint32_t p = 0; p < kPixels; ++p)
            for (int c = 0; c < 3; ++c) {
                const double d = image.mean[p][c] - static_cast<double>(test::splatted_radiance(p)[c]);
                mse += d * d / (3 * kPixels);
            }
        estimated += error.mse();
        truth += mse;
        covered += error.low <= std::sqrt(mse) && std::sqrt(mse) <= error.high;
    }
    EXPECT_NEAR(estimated / truth, 1.0, 0.06);
    EXPECT_GE(covered, kRuns * 8 / 10);
}

TEST(Develop, LayersAddUpWhereAHalfHasBoth) {
    const SplatShape shape{2, -4};
    SplatLog log;
    log.begin(shape);
    log.add(0, 2, Rgb(3.0f), {});
    log.add(1, 3, Rgb(5.0f), {});
    SplatSums sums(shape);
    sums.add(log.summed(), {});
    std::vector<PixelEstimate> pixels(2);
    for (PixelEstimate& pixel : pixels)
        for (std::uint32_t s = 0; s < 4; ++s)
            pixel.add(s, Rgb(s < 2 ? 1.0f : 2.0f));
    const std::vector<PixelEstimate> both = develop(pixels, sums, {3, 3});
    EXPECT_DOUBLE_EQ(both[0].half[0].mean.x, 1.5 + 3.0 / 3);
    EXPECT_DOUBLE_EQ(both[0].half[1].mean.x, 1.5);
    EXPECT_DOUBLE_EQ(both[1].half[1].mean.x, 1.5 + 5.0 / 3);
    const double atoms = 0.5 / 2;  // variance of the mean of 1 and 2
    EXPECT_DOUBLE_EQ(both[0].half[1].sample_variance().x / 2, atoms);
    EXPECT_GE(both[0].half[0].sample_variance().x / 2, atoms);
    // A half that a layer knows nothing of would be too dark.
    const std::vector<PixelEstimate> one = develop(pixels, sums, {1, 0});
    EXPECT_EQ(one[0].half[0].n, 2u);
    EXPECT_EQ(one[0].half[1].n, 0u);
}

}  // namespace
}  // namespace treefarm
