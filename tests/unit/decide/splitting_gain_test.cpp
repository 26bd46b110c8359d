// SPDX-License-Identifier: Apache-2.0
// Whether splitting pays, from samples whose moments are known.
#include "common/decide/splitting/splitting_gain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/decide/emission/emission_shares.h"
#include "common/decide/light_subpaths/light_subpath_constants.h"
#include "common/film/splat_film.h"
#include "common/plan/forecast/budget.h"
#include "common/plan/schedule/schedule.h"
#include "tests/support/losing_pass.h"
#include "tests/support/resolved.h"
#include "worker/integrators/path/split_paths.h"
#include "worker/integrators/unit_stats.h"

namespace treefarm {
namespace {

TEST(SplittingGain, ComparesVarianceAndRays) {
    UnitStats stats;
    PairedSamples pixel;
    for (const double s : {0.0, 2.0})
        pixel.add(1 + 0.5 * (s - 1), s);
    pixel.finish(stats.sums<SplittingSums>());
    stats.rays = 500;
    stats.split_path_rays = 100;
    const SplittingGain gain = splitting_gain(stats.sums<SplittingSums>(), stats);
    EXPECT_NEAR(gain.variance, 4, 1e-3);
    EXPECT_NEAR(gain.mean_ratio, 1, 1e-3);
    EXPECT_DOUBLE_EQ(gain.rays, 500.0 / 400);
}

TEST(SplittingGain, PixelsAddUpInAnyOrder) {
    SplittingSums first, second;
    PairedSamples pixel;
    for (const int order : {1, -1})
        for (int i = 0; i < 100; ++i) {
            const int p = order > 0 ? i : 99 - i;
            for (int s = 0; s < 5; ++s)
                pixel.add(0.1 * p + 0.3 * s, 0.2 * p * s);
            pixel.finish(order > 0 ? first : second);
        }
    EXPECT_EQ(first.split_mean, second.split_mean);
    EXPECT_EQ(first.unsplit_mean, second.unsplit_mean);
    EXPECT_EQ(first.split_variance, second.split_variance);
    EXPECT_EQ(first.unsplit_variance, second.unsplit_variance);
    EXPECT_GT(first.unsplit_variance, 0u);
}

TEST(SplittingGain, OneSampleHasNoVarianceAndNonsenseIsLeftOut) {
    SplittingSums sums;
    PairedSamples pixel;
    pixel.finish(sums);
    pixel.add(1, 2);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0}) {
        pixel.add(bad, 1);
        pixel.add(1, bad);
    }
    pixel.finish(sums);
    EXPECT_EQ(sums.split_mean + sums.unsplit_mean + sums.split_variance + sums.unsplit_variance, 0u);
    EXPECT_EQ(splitting_gain({}, {}).variance, 0) << "not known";
}

/// Sums over as many pixels as there can be, as bright as they come, do not wrap around.
TEST(SplittingGain, BrightSamplesAreBounded) {
    UnitStats stats;
    PairedSamples pixel;
    for (const double s : {0.0, 1e300})
        pixel.add(s, s);
    pixel.finish(stats.sums<SplittingSums>());
    const double most = PairedSamples::kMost * PairedSamples::kMost / 2;
    EXPECT_LT(std::ldexp(most, 29) * 4096, std::ldexp(1.0, 64) * 1.001);
    EXPECT_EQ(stats.sums<SplittingSums>().split_variance, static_cast<std::uint64_t>(most * 4096));
}

TEST(SplittingGain, APathKnowsWhatItWouldCarryAlone) {
    Unsplit alone;
    EXPECT_EQ(alone.of(3.0f), 3.0f);
    Unsplit path;         // finds 1 before it is split in two, then 2 for both, then 3 for all six
    path.split(2, 1.0f);  // 2 more count as 4
    path.split(3, 3.0f);  // 3 more count as 18
    EXPECT_EQ(path.of(6.0f), 1.0f + 4.0f + 18.0f);
    path.split(1, 6.0f);
    EXPECT_EQ(path.of(6.0f), 23.0f);
}

bool may_pay(std::uint32_t spp, SplittingGain gain, bool next_event = false) {
    PassPlan pass;
    pass.spp = spp;
    pass.next_event = next_event;
    return splitting_may_pay(pass, gain);
}

TEST(SplittingGain, HasToReduceVariance) {
    EXPECT_TRUE(may_pay(64, {})) << "not known";
    EXPECT_TRUE(may_pay(16, {2.0, 1.5, 1.0}));
    EXPECT_TRUE(may_pay(16, {1.04, 1.05, 1.0})) << "whole renders gain more by it";
    EXPECT_FALSE(may_pay(16, {1.0, 1.0, 1.0}));
    EXPECT_FALSE(may_pay(128, {1.016, 1.177, 1.0}));
    EXPECT_TRUE(may_pay(8, {1.0, 1.0, 1.0})) << "too short to say";
    EXPECT_TRUE(may_pay(64, {0.6, 1.7, 0.7})) << "unsplit samples have missed light, which makes no noise";
}

TEST(SplittingGain, HasToShowMoreWithNextEvent) {
    EXPECT_TRUE(may_pay(64, {1.47, 1.23, 1.0}));
    EXPECT_FALSE(may_pay(64, {1.47, 1.23, 1.0}, true)) << "the ajar door";
    EXPECT_TRUE(may_pay(64, {1.25, 1.09, 1.0}, true)) << "cbox";
    EXPECT_TRUE(may_pay(16, {1.03, 1.013, 1.0}, true)) << "the matte room";
    EXPECT_FALSE(may_pay(16, {1.0, 1.0, 1.0}, true));
    EXPECT_TRUE(may_pay(8, {1.0, 1.5, 1.0}, true)) << "too short to say";
    EXPECT_TRUE(may_pay(64, {1.0, 1.5, 0.7}, true)) << "unsplit samples have missed light, which makes no noise";
}

TEST(SplittingGain, WhatTheJobAsksForIsDone) {
    Job job;
    PassPlan pass = make_pass(test::resolved(job), 5, 31, 32, false);
    EXPECT_FALSE(test::after_losing_pass(test::resolved(job), pass).split);
    Decisions::apply(pass, {}, true);
    EXPECT_TRUE(pass.split);
    job.guiding.splitting = 4;
    EXPECT_TRUE(test::after_losing_pass(test::resolved(job), pass).split);
    job.guiding.splitting = 0;
    job.budget.spp = 31;
    RenderHistory state;
    state.decisions.get<SplittingDecision::Memory>().pays = false;
    EXPECT_FALSE(passes_of(test::resolved(job))(state).pass->split);
}

TEST(LightSubpathGain, ComparesVarianceAndRays) {
    UnitStats stats;
    SubpathPairs pixel;
    // Alone: 0 or 4, variance 8. Both: 1 or 2, variance 1/2, and a splat of 1 for each of two samples, 1 by their
    // squares.
    pixel.add({.own = 1, .alone = 0, .splats = 1, .splat_squares = 1});
    pixel.add({.own = 2, .alone = 4, .splats = 1, .splat_squares = 1});
    pixel.finish(stats.sums<LightSubpathSums>());
    stats.rays = 300;
    stats.shadow_rays = 100;
    stats.sums<LightSubpathSums>().alone_rays = 200;
    const LightSubpathGain gain = light_subpath_gain(stats.sums<LightSubpathSums>(), stats);
    EXPECT_NEAR(gain.noise, 8 / 1.5, 1e-6);
    EXPECT_NEAR(gain.mean_ratio, 2 / 2.5, 1e-6);
    EXPECT_DOUBLE_EQ(gain.rays, 2.0);
    EXPECT_NEAR(gain.at_equal_cost(), 8 / 1.5 / (2 * tuned<policy::kLightSubpaths>("light_subpaths.ray_cost")), 1e-6);
}

TEST(LightSubpathGain, OneSampleHasNoVarianceAndNonsenseIsLeftOut) {
    LightSubpathSums sums;
    SubpathPairs pixel;
    pixel.add({.own = 1, .alone = 2});
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0}) {
        pixel.add({.own = bad, .alone = 1});
        pixel.add({.own = 1, .alone = bad});
    }
    pixel.finish(sums);
    EXPECT_EQ(sums.samples + sums.both_mean + sums.alone_mean + sums.both_variance + sums.alone_variance, 0u);
    EXPECT_EQ(light_subpath_gain({}, {}).noise, 0) << "not known";
    EXPECT_EQ(light_subpath_gain({}, {}).at_equal_cost(), 0);
}

/// Four pixels of eight samples, in each of which light subpaths bring something more than what paths from the camera
/// have met: by theory its square is variance over samples.
TEST(LightSubpathGain, MissedLightIsNoiseThatNobodyHasSeen) {
    const auto noise = [](double splat, bool a_sample_alone = false) {
        UnitStats stats;
        stats.rays = stats.sums<LightSubpathSums>().alone_rays = 1;
        SubpathPairs pixel;
        const SubpathPairs::Sample sample{.own = 1, .alone = 1, .splats = splat, .splat_squares = 0.5};
        for (int pixels = 0; pixels < 4; ++pixels) {
            for (int i = 0; i < 8; ++i)
                pixel.add(sample);
            pixel.finish(stats.sums<LightSubpathSums>());
            if (!a_sample_alone) continue;
            pixel.add(sample);
            pixel.finish(stats.sums<LightSubpathSums>());
        }
        return light_subpath_gain(stats.sums<LightSubpathSums>(), stats).noise;
    };
    EXPECT_NEAR(noise(1.0), 32 / 0.5, 1e-4) << "camera paths alone show none";
    EXPECT_EQ(noise(1.0, true), noise(1.0)) << "passes of 9 spp: a block of one sample has no variance";
    const double error = std::sqrt(0.5 / 32),
                 least = tuned<policy::kLightSubpaths>("light_subpaths.missed_errors") * error;
    EXPECT_NEAR(noise(1.01 * least), std::pow(1.01 * least / error, 2), 1e-4);
    EXPECT_EQ(noise(0.99 * least), 0) << "within the error";
    EXPECT_EQ(noise(0.0), 0) << "nothing is missed";
}

TEST(LightSubpathGain, AVerdictNeedsSamplesThatFoundTheLight) {
    const auto may_pay = [](std::uint32_t spp, const LightSubpathGain& gain) {
        PassPlan pass;
        pass.spp = spp;
        return light_subpaths_may_pay(pass, gain);
    };
    EXPECT_TRUE(may_pay(64, {})) << "not known";
    EXPECT_FALSE(may_pay(4, {1.2, 2.0, 1.0}));
    EXPECT_TRUE(may_pay(2, {1.2, 2.0, 1.0})) << "too short to say";
    EXPECT_TRUE(may_pay(64, {10.0, 2.0, 1.0}));
    EXPECT_TRUE(may_pay(64, {1.2, 2.0, 0.7})) << "paths from the camera have missed light, which makes no noise";
}

TEST(LightSubpathGain, WhatTheJobAsksForIsDone) {
    Job job;
    job.integrator.type = "bidirectional";
    const auto next = [](const Resolved& resolved) {
        RenderHistory state;
        state.decisions = test::after_losing_pass(resolved);
        return *passes_of(resolved)(state).pass;
    };
    EXPECT_FALSE(next(test::resolved(job)).light_subpaths);
    EXPECT_EQ(next(test::resolved(job)).layers.splats.pixels, 0u);
    job.bidirectional.light_subpaths = Rule::always;
    EXPECT_TRUE(next(test::resolved(job)).light_subpaths);
    job.bidirectional.light_subpaths = Rule::usual;
    job.bidirectional.techniques = "1,2";
    EXPECT_TRUE(next(test::resolved(job)).light_subpaths) << "techniques are asked for";
}

/// Noise is least where emitters are chosen by the root of their second moment: for two of power one half each, whose
/// paths bring 1 and 4 squared on average, half and twice as much.
TEST(EmissionShares, GoByTheRootOfTheSecondMoment) {
    const EmissionSums sums{{1u << 30, 1u << 30}, {std::uint64_t{1} << 30, std::uint64_t{4} << 30}};
    const std::vector<float> emphasis = emission_emphasis(sums);
    ASSERT_EQ(emphasis.size(), 2u);
    EXPECT_NEAR(double(emphasis[1]) / double(emphasis[0]), 2.0, 1e-5);
    EXPECT_TRUE(emission_emphasis({}).empty());
    EXPECT_TRUE(emission_emphasis({{5}, {7}}).empty()) << "no choice";
    EXPECT_TRUE(emission_emphasis({{5, 6}, {0, 0}}).empty()) << "no light found";
}

TEST(EmissionShares, OfEmittersThatFewPathsTriedAreThoseOfAll) {
    const std::vector<float> emphasis = emission_emphasis({{1u << 20, 0, 1u << 20}, {1u << 22, 0, 1u << 22}});
    EXPECT_NEAR(double(emphasis[1]) / double(emphasis[0]), 1.0, 1e-3);
}

TEST(EmissionShares, SumsAreTheSameInAnyOrder) {
    const EmissionSums parts[] = {{{1, 2, 3}, {4, kMostSplatSum, 6}}, {{}, {}}, {{7, 8, 9}, {1, 2, kMostSplatSum - 1}}};
    EmissionSums forward, backward;
    for (int i = 0; i < 3; ++i) {
        forward.add(parts[i]);
        backward.add(parts[2 - i]);
    }
    EXPECT_EQ(forward.paths, (std::vector<std::uint64_t>{8, 10, 12}));
    EXPECT_EQ(forward.squares, (std::vector<std::uint64_t>{5, kMostSplatSum, kMostSplatSum}));
    EXPECT_EQ(forward.paths, backward.paths);
    EXPECT_EQ(forward.squares, backward.squares);
}

TEST(EmissionShares, HalfOfThePathsStartAtTheFewest) {
    EXPECT_EQ(emitters_of_half({{1, 10, 1, 8}, {0, 0, 0, 0}}), 1u);
    EXPECT_EQ(emitters_of_half({{5, 5, 5, 5}, {0, 0, 0, 0}}), 2u);
    EXPECT_EQ(emitters_of_half({}), 0u);
}

}  // namespace
}  // namespace treefarm
