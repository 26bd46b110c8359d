// The verdict on guiding, from pixels whose variances are known.
#include "common/film/guiding_probe.h"

#include <gtest/gtest.h>

#include <random>

#include "common/plan/schedule.h"

namespace treefarm {
namespace {

/// Pixels of mean 1 whose samples deviate by `unguided` in probe pixels and by `guided` in the others.
std::vector<PixelEstimate> pixels(float guided, float unguided) {
    std::vector<PixelEstimate> result(8192);
    for (std::uint32_t p = 0; p < result.size(); ++p) {
        const float deviation = is_probe_pixel(p) ? unguided : guided;
        for (std::uint32_t s = 0; s < 8; ++s)
            result[p].add(s, Rgb(s % 4 < 2 ? 1 + deviation : 1 - deviation));
    }
    return result;
}

const std::vector<Rgb64> kImage(8192, Rgb64(1.0));
constexpr ProbeCounts kSame{100, 500};

TEST(GuidingProbe, ComparesVarianceTimesCost) {
    const double even = guiding_gain(pixels(0.5f, 0.5f), kImage, kSame, kSame);
    EXPECT_NEAR(even, 1 / kGuidedRayCost, 1e-6);
    EXPECT_NEAR(guiding_gain(pixels(0.25f, 0.5f), kImage, kSame, kSame), 4 * even, 1e-6);
    EXPECT_NEAR(guiding_gain(pixels(0.5f, 0.5f), kImage, {100, 1000}, kSame), even / 2, 1e-6);
    EXPECT_NEAR(guiding_gain(pixels(0.5f, 0.5f), kImage, kSame, {100, 250}), even / 2, 1e-6);
}

TEST(GuidingProbe, AFireflyDecidesNothing) {
    std::vector<PixelEstimate> noisy = pixels(0.5f, 0.5f);
    for (std::uint32_t p = 0, found = 0; found < 1; ++p)
        if (is_probe_pixel(p)) noisy[p].add(8, Rgb(1e6f)), ++found;
    EXPECT_NEAR(guiding_gain(noisy, kImage, kSame, kSame), 1 / kGuidedRayCost, 0.01);
}

TEST(GuidingProbe, SaysWhenItKnowsNothing) {
    EXPECT_EQ(guiding_gain({}, {}, kSame, kSame), 0);
    const std::vector<Rgb64> black(8192, Rgb64(0.0));
    EXPECT_EQ(guiding_gain(pixels(0.5f, 0.5f), black, kSame, kSame), 0);
    const std::vector<PixelEstimate> few = pixels(0.5f, 0.5f);
    EXPECT_EQ(guiding_gain(std::span(few).first(100), std::span(kImage).first(100), kSame, kSame), 0);
    EXPECT_EQ(guiding_gain(pixels(0.0f, 0.0f), kImage, kSame, kSame), 0) << "no noise at all";
}

TEST(GuidingProbe, LongPassesAreBelievedSooner) {
    PassPlan pass;
    pass.spp = 32;
    EXPECT_TRUE(guiding_pays(pass, 0.6));
    EXPECT_FALSE(guiding_pays(pass, 0.4));
    pass.spp = 128;
    EXPECT_FALSE(guiding_pays(pass, 0.8));
    EXPECT_TRUE(guiding_pays(pass, 0.95));
    EXPECT_TRUE(guiding_pays(pass, 0)) << "not known";
}

TEST(GuidingProbe, OnlyAutoProbesAndOnlyWhatTeaches) {
    Job job;
    for (const auto& [type, probes] : {std::pair{GuidingType::automatic, true}, {GuidingType::view, false}}) {
        job.guiding.type = type;
        PassPlan pass = make_pass(job, 5, 31, 32, false);
        set_guiding(pass, job, true);
        EXPECT_EQ(pass.probe, probes);
        set_guiding(pass, job, false);
        EXPECT_EQ(pass.guided, !probes);
        EXPECT_EQ(pass.record, !probes);
        EXPECT_FALSE(probes && pass.probe);
    }
    job.guiding.type = GuidingType::automatic;
    PassPlan last = make_pass(job, 6, 63, 64, true);
    set_guiding(last, job, true);
    EXPECT_FALSE(last.probe);
    EXPECT_TRUE(last.guided);
}

}  // namespace
}  // namespace treefarm
