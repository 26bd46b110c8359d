// SPDX-License-Identifier: Apache-2.0
// The verdict on guiding, from pixels whose variances are known.
#include "common/film/guiding_probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "common/film/combine.h"
#include "common/plan/policy.h"
#include "common/plan/schedule.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

constexpr std::size_t kWidth = 128, kCount = 8192;
constexpr std::uint32_t kPass = 3;
const ProbePixels kProbe(kCount, kPass);
const std::vector<Rgb64> kImage(kCount, Rgb64(1.0));

/// Pixels of mean 1 whose samples deviate by `unguided` in probe pixels and by `guided` in the others.
std::vector<PixelEstimate> pixels(float guided, float unguided, std::uint32_t spp = 8) {
    std::vector<PixelEstimate> result(kCount);
    for (std::uint32_t p = 0; p < result.size(); ++p) {
        const float deviation = kProbe.holds(p) ? unguided : guided;
        for (std::uint32_t s = 0; s < spp; ++s)
            result[p].add(s, Rgb(s % 4 < 2 ? 1 + deviation : 1 - deviation));
    }
    return result;
}

struct Rays {
    std::uint64_t guided = 500, unguided = 500;  ///< for 100 paths each
};

TraceStats stats_of(Rays rays) {
    TraceStats stats;
    stats.paths = 200;
    stats.probe_paths = 100;
    stats.rays = rays.guided + rays.unguided;
    stats.probe_rays = rays.unguided;
    return stats;
}

GuidingGain both_gains(std::span<const PixelEstimate> samples, std::span<const Rgb64> image = kImage, Rays rays = {}) {
    GuidingProbe probe;
    probe.add(samples, stats_of(rays), kPass);
    return probe.gain(samples, stats_of(rays), kPass, image, kWidth);
}

double gain(std::span<const PixelEstimate> samples, std::span<const Rgb64> image = kImage, Rays rays = {}) {
    return both_gains(samples, image, rays).all;
}

TEST(GuidingProbe, ComparesVarianceTimesCost) {
    const double even = gain(pixels(0.5f, 0.5f));
    EXPECT_NEAR(even, 1 / kPolicy.guiding.ray_cost, 1e-6);
    EXPECT_NEAR(gain(pixels(0.25f, 0.5f)), 4 * even, 1e-6);
    EXPECT_NEAR(gain(pixels(0.5f, 0.5f), kImage, {1000, 500}), even / 2, 1e-6);
    EXPECT_NEAR(gain(pixels(0.5f, 0.5f), kImage, {500, 250}), even / 2, 1e-6);
}

TEST(GuidingProbe, LaterPassesNeedNoProbes) {
    GuidingProbe probe;
    std::vector<PixelEstimate> first = pixels(0.5f, 0.5f);
    probe.add(first, stats_of({}), kPass);
    TraceStats later;
    later.paths = 100;
    later.rays = 500;
    EXPECT_NEAR(probe.gain(pixels(0.25f, 0.25f), later, 5, kImage, kWidth).all, 4 / kPolicy.guiding.ray_cost, 1e-6);
}

TEST(GuidingProbe, LongerProbesCountMore) {
    GuidingProbe probe;
    probe.add(pixels(0.5f, 0.5f, 4), stats_of({}), kPass);   // a variance of 1/3: 4 samples of squared deviation 1/4
    probe.add(pixels(0.5f, 1.0f, 16), stats_of({}), kPass);  // 16/15
    const double unguided = (3 * (1.0 / 3) + 15 * (16.0 / 15)) / 18, guided = 2.0 / 7;
    const std::vector<PixelEstimate> now = pixels(0.5f, 0.5f);
    EXPECT_NEAR(probe.gain(now, stats_of({}), kPass, kImage, kWidth).all, unguided / guided / kPolicy.guiding.ray_cost,
                2e-3);
}

TEST(GuidingProbe, AFireflyDecidesNothing) {
    std::vector<PixelEstimate> noisy = pixels(0.5f, 0.5f);
    for (std::uint32_t p = 0, found = 0; found < 1; ++p)
        if (kProbe.holds(p)) noisy[p].add(8, Rgb(1e6f)), ++found;
    EXPECT_NEAR(gain(noisy), 1 / kPolicy.guiding.ray_cost, 0.01);
}

/// Where one sample in a thousand finds a light, pixels that found it are as bright as they are noisy, the others as
/// dark as they are quiet: relative to themselves they would look alike.
TEST(GuidingProbe, RareLightIsNotOverlooked) {
    std::mt19937 random(1);
    std::vector<PixelEstimate> samples(kCount);
    std::vector<Rgb64> image;
    for (std::uint32_t p = 0; p < samples.size(); ++p) {
        for (std::uint32_t s = 0; s < 16; ++s) {
            const bool found = random() % 1000 == 0;
            samples[p].add(s, Rgb(!kProbe.holds(p) ? (s % 2 ? 4.0f : -2.0f) : found ? 1000.0f : 0.0f));
        }
        image.push_back(samples[p].whole().mean);
    }
    EXPECT_GT(gain(samples, image), 5) << "relative to itself 0.02";
}

TEST(GuidingProbe, SaysWhenItKnowsNothing) {
    EXPECT_EQ(gain({}, {}), 0);
    const std::vector<Rgb64> black(kCount, Rgb64(0.0));
    EXPECT_EQ(gain(pixels(0.5f, 0.5f), black), 0);
    std::vector<PixelEstimate> few = pixels(0.5f, 0.5f);
    few.resize(100);
    EXPECT_EQ(gain(few, std::span(kImage).first(100)), 0);
    EXPECT_EQ(gain(pixels(0.0f, 0.0f)), 0) << "no noise at all";
    EXPECT_EQ(GuidingProbe().gain(pixels(0.5f, 0.5f), stats_of({}), kPass, kImage, kWidth).all, 0) << "no probe yet";
}

Guiding verdict(std::uint32_t spp, double all, double bulk = 0.65, double coverage = 0.95, bool next_event = true) {
    PassPlan pass;
    pass.spp = spp;
    pass.next_event = next_event;
    return judge_guiding(pass, {all, bulk, coverage});
}

TEST(GuidingProbe, LongPassesAreBelievedSooner) {
    EXPECT_EQ(verdict(2, 0.1), Guiding::open);
    EXPECT_EQ(verdict(4, 0.6), Guiding::open);
    EXPECT_EQ(verdict(4, 0.5), Guiding::loses);
    EXPECT_EQ(verdict(8, 1.4), Guiding::loses);
    EXPECT_EQ(verdict(8, 0), Guiding::open) << "not known";
}

/// Few samples, of bright paths that are rare, may say the contrary of all others.
TEST(GuidingProbe, TheBulkOfThePixelsDecides) {
    EXPECT_EQ(verdict(4, 0.5, 0.72), Guiding::open);
    EXPECT_EQ(verdict(128, 0.5, 0.72), Guiding::open);
    EXPECT_EQ(verdict(128, 1.4, 0.69), Guiding::loses);
    EXPECT_EQ(verdict(128, 1.6, 0.3), Guiding::open) << "light that few unguided samples find";
}

/// A sun that one path in a million finds makes no noise until it is found.
TEST(GuidingProbe, SamplesThatFindNoLightSayNothing) {
    EXPECT_EQ(verdict(4, 0.2, 0.2, 0.5), Guiding::pays);
    EXPECT_EQ(verdict(4, 0.2, 0.2, 0.85), Guiding::loses);
}

/// Samples that find part of the light do not say how noisy what they miss would be.
TEST(GuidingProbe, TheBulkIsThatOfTheLightThatIsFound) {
    EXPECT_EQ(verdict(8, 0.7, 0.67, 0.86), Guiding::open);
    EXPECT_EQ(verdict(8, 0.7, 0.67, 0.93), Guiding::loses);
    EXPECT_EQ(verdict(8, 0.7, 0.74, 1.5), Guiding::loses);
    EXPECT_EQ(verdict(8, 0.7, 0.76, 1.5), Guiding::open);
}

/// Figures of the spaceship, where guiding ends with 1.4 times less error.
TEST(GuidingProbe, WhereLightIsFoundByChanceItHasToLoseMore) {
    for (const auto& [spp, all, bulk] :
         {std::tuple{8, 0.67, 0.72}, {8, 0.8, 0.64}, {16, 0.59, 0.66}, {32, 0.66, 0.67}}) {
        const auto samples = static_cast<std::uint32_t>(spp);
        EXPECT_EQ(verdict(samples, all, bulk, 0.9, false), Guiding::open);
        EXPECT_EQ(verdict(samples, all, bulk, 1.0, true), Guiding::loses);
    }
    EXPECT_EQ(verdict(8, 0.7, 0.43, 0.9, false), Guiding::loses);
}

TEST(GuidingProbe, NobodyProbesOnceTheVerdictIsOut) {
    const Job job;
    for (const auto& [guiding, guided, probe] :
         {std::tuple{Guiding::open, true, true}, {Guiding::pays, true, false}, {Guiding::loses, false, false}}) {
        PassPlan pass = make_pass(test::resolved(job), 3, 7, 8, false);
        set_guiding(pass, test::resolved(job), guiding);
        EXPECT_EQ(pass.guided, guided);
        EXPECT_EQ(pass.record, guided);
        EXPECT_EQ(pass.probe, probe);
    }
}

TEST(GuidingProbe, CoverageIsWhatUnguidedSamplesFindEvenly) {
    const std::vector<PixelEstimate> even = pixels(0.5f, 0.5f);
    EXPECT_NEAR(both_gains(even).coverage, 1 / std::sqrt(1.01), 1e-6);  // of the floor
    std::vector<PixelEstimate> rare(kCount);
    std::uint32_t probes = 0;
    for (std::uint32_t p = 0; p < rare.size(); ++p) {
        const bool found = kProbe.holds(p) ? probes++ % 20 == 0 : p % 2 == 0;
        for (std::uint32_t s = 0; s < 8; ++s)
            rare[p].add(s, Rgb(found && s == 0 ? 160.0f : 0.0f));  // 20 on average: a mean of 1
    }
    EXPECT_NEAR(both_gains(rare).coverage, 3.0 / 20, 0.01);
}

TEST(GuidingProbe, TheBulkLeavesOutOnePixelInAHundred) {
    std::vector<PixelEstimate> noisy = pixels(0.5f, 0.5f);
    for (std::uint32_t p = 0, found = 0; found < 8; ++p)  // of a thousand
        if (kProbe.holds(p)) noisy[p].add(8, Rgb(1e3f)), ++found;
    const GuidingGain gain = both_gains(noisy);
    EXPECT_GT(gain.all, 10);
    EXPECT_NEAR(gain.bulk, 1 / kPolicy.guiding.ray_cost, 0.01);
}

TEST(GuidingProbe, TakesAnEighthOfASmallFilmAndLessOfALargeOne) {
    for (const auto& [film, expected] : {std::pair{4096u, 512.0}, {65536u, 2048.0}, {1u << 22, 32768.0}}) {
        const ProbePixels probe(film, 2);
        double held = 0;
        for (std::uint32_t p = 0; p < film; ++p)
            held += probe.holds(p);
        EXPECT_NEAR(held, expected, 0.02 * expected) << film;
    }
    EXPECT_FALSE(ProbePixels().holds(0));
}

TEST(GuidingProbe, NoPixelIsProbedTwice) {
    for (std::uint32_t p = 0; p < 4096; ++p) {
        int passes = 0;
        for (std::uint32_t pass = 0; pass < 8; ++pass)
            passes += ProbePixels(4096, pass).holds(p);
        EXPECT_EQ(passes, 1);
    }
}

/// A probe pixel's image is what other passes know of it, whole and unshaded.
TEST(GuidingProbe, ProbesAreNoPartOfTheImage) {
    std::vector<PixelEstimate> marked = pixels(0.0f, 9.0f);
    ProbesSetAside().take_out(marked, kPass, 0);
    std::vector<PixelEstimate> other = pixels(0.0f, 0.0f, 4);
    const std::vector<PassResult> passes = {{4, 0, other, false}, {8, 4, marked, false}};
    for (const Combination method : {Combination::fixed, Combination::inverse_variance, Combination::last})
        for (const Rgb64& c :
             combine_passes(std::span(passes).first(method == Combination::last ? 1 : 2), method, true).mean)
            EXPECT_EQ(c, Rgb64(1.0));
}

TEST(GuidingProbe, ProbesComeBackToTheirPass) {
    const std::vector<PixelEstimate> before = pixels(0.0f, 9.0f);
    std::vector<PassResult> passes = {{4, 0, pixels(0.0f, 0.0f, 4), false}, {8, 4, before, false}};
    ProbesSetAside aside;
    aside.take_out(passes[1].pixels, kPass, 1);
    for (std::uint32_t p = 0; p < kCount; ++p)
        ASSERT_EQ(passes[1].pixels[p].whole().n, kProbe.holds(p) ? 0u : 8u);
    remember_noise(passes, Combination::inverse_variance, true);
    aside.put_back(passes);
    for (const PassResult& pass : passes)
        EXPECT_EQ(pass.noise.passes, 0u) << "it was measured without them";
    for (std::uint32_t p = 0; p < kCount; ++p) {
        ASSERT_EQ(passes[0].pixels[p].whole().n, 4u);
        ASSERT_EQ(passes[1].pixels[p].whole().m2, before[p].whole().m2);
    }
    passes.clear();
    aside.put_back(passes);  // nothing is left to give
}

/// Passes too short to be weighed by variance are all that is known of a pixel that the first longer one left out.
TEST(GuidingProbe, NoPixelIsBlackForWantOfWeight) {
    std::vector<PixelEstimate> marked = pixels(0.5f, 0.5f, 4);
    ProbesSetAside().take_out(marked, kPass, 0);
    const std::vector<PassResult> passes = {
        {1, 0, pixels(0.0f, 0.0f, 1), false}, {2, 1, pixels(0.0f, 0.0f, 2), false}, {4, 3, marked, false}};
    const CombinedImage image = combine_passes(passes, Combination::inverse_variance, true);
    for (std::uint32_t p = 0; p < kCount; ++p) {
        EXPECT_EQ(image.mean[p], Rgb64(1.0));
        EXPECT_EQ(image.half[0][p], Rgb64(1.0));
    }
}

TEST(GuidingProbe, OnlyAutoProbesAndOnlyInItsFirstPasses) {
    Job job;
    for (const auto& [type, probes] : {std::pair{GuidingType::automatic, true}, {GuidingType::view, false}}) {
        job.guiding.type = type;
        for (const auto& [index, spp] : {std::pair{1u, 2u}, {2u, 4u}, {4u, 16u}, {5u, 32u}}) {
            PassPlan pass = make_pass(test::resolved(job), index, spp - 1, spp, false);
            set_guiding(pass, test::resolved(job), Guiding::open);
            EXPECT_EQ(pass.probe, probes && spp >= 4 && spp <= 16) << spp;
            set_guiding(pass, test::resolved(job), Guiding::loses);
            EXPECT_EQ(pass.guided, !probes);
            EXPECT_EQ(pass.record, !probes);
            EXPECT_FALSE(probes && pass.probe);
        }
    }
    job.guiding.type = GuidingType::automatic;
    PassPlan last = make_pass(test::resolved(job), 4, 15, 16, true);
    set_guiding(last, test::resolved(job), Guiding::open);
    EXPECT_FALSE(last.probe);
    EXPECT_TRUE(last.guided);
}

}  // namespace
}  // namespace treefarm
