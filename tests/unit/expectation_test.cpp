// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/expectation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/resolved.h"

namespace treefarm {
namespace {

constexpr double kVariance = 4, kMean = 0.5, kSecondsPerSpp = 0.01;

/// Passes of 1, 2, 4... spp without guiding, of a scene whose samples all have the same variance.
RenderHistory plain_state(std::uint32_t passes) {
    RenderHistory state;
    for (std::uint32_t k = 0; k < passes; ++k) {
        PassFacts facts;
        facts.spp = 1u << k;
        facts.spp_before = state.spp();
        facts.mse_of_sample = facts.stuv_trimmed = kVariance;
        facts.trace_core_seconds = facts.collect_seconds = kSecondsPerSpp * facts.spp;
        facts.next_event = true;
        state.passes.push_back(facts);
    }
    state.seconds = kSecondsPerSpp * state.spp();
    state.error.known = state.error.has_interval = true;
    state.error.rmse = std::sqrt(kVariance / state.spp());
    state.error.low = 0.95 * state.error.rmse;
    state.error.high = 1.05 * state.error.rmse;
    state.error.mean = kMean;
    return state;
}

Job plain_job() {
    Job job;
    job.guiding.type = GuidingType::none;
    return job;
}

void expect_holds(const Expected& figure, double truth, double within) {
    EXPECT_NEAR(figure.value, truth, within * truth);
    EXPECT_LT(figure.low, truth);
    EXPECT_GT(figure.high, truth);
}

TEST(Expectation, OfAnErrorIsWhatItsVarianceTakes) {
    const Expectation all = expect_error(plain_state(5), test::resolved(plain_job()), 0.05);
    ASSERT_TRUE(all.known);
    const double spp = kVariance / std::pow(0.05 * kMean, 2);
    expect_holds(all.spp, spp, 0.03);
    expect_holds(all.seconds, kSecondsPerSpp * spp, 0.03);
    EXPECT_EQ(all.error.value, 0.05);
}

TEST(Expectation, OfTimeAndSamplesIsTheErrorThen) {
    const double spp = 1000, error = std::sqrt(kVariance / spp) / kMean;
    const Expectation timed = expect_after_seconds(plain_state(5), test::resolved(plain_job()), kSecondsPerSpp * spp);
    ASSERT_TRUE(timed.known);
    expect_holds(timed.spp, spp, 0.03);
    expect_holds(timed.error, error, 0.03);
    EXPECT_EQ(timed.seconds.high, kSecondsPerSpp * spp);
    const Expectation counted = expect_after_spp(plain_state(5), test::resolved(plain_job()), spp);
    ASSERT_TRUE(counted.known);
    expect_holds(counted.seconds, kSecondsPerSpp * spp, 0.03);
    expect_holds(counted.error, error, 0.03);
    EXPECT_EQ(counted.spp.low, spp);
}

TEST(Expectation, WhatTheProbeReachedIsMeasured) {
    const RenderHistory state = plain_state(5);
    for (const Expectation& all : {expect_error(state, test::resolved(plain_job()), 1.0),
                                   expect_after_seconds(state, test::resolved(plain_job()), 0.01),
                                   expect_after_spp(state, test::resolved(plain_job()), 1)}) {
        EXPECT_TRUE(all.known && all.reached);
        EXPECT_EQ(all.spp.value, 31);
    }
    RenderHistory quiet = state;
    quiet.error.rmse = quiet.error.low = quiet.error.high = 0;
    EXPECT_TRUE(expect_error(quiet, test::resolved(plain_job()), 0.05).reached) << "no noise";
}

TEST(Expectation, IsNotKnownWithoutLightOrSamples) {
    RenderHistory dark = plain_state(5);
    dark.error.rmse = dark.error.low = dark.error.high = dark.error.mean = 0;
    EXPECT_NE(expect_error(dark, test::resolved(plain_job()), 0.05).unknown.find("no light"), std::string::npos);
    RenderHistory short_one = plain_state(1);
    short_one.error.known = false;
    for (const Expectation& all : {expect_error(short_one, test::resolved(plain_job()), 0.05),
                                   expect_after_seconds(short_one, test::resolved(plain_job()), 60),
                                   expect_after_spp(short_one, test::resolved(plain_job()), 100)}) {
        EXPECT_FALSE(all.known);
        EXPECT_NE(all.unknown.find("too few samples"), std::string::npos);
    }
}

}  // namespace
}  // namespace treefarm
