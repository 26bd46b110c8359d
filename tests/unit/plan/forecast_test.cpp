// SPDX-License-Identifier: Apache-2.0
// Forecasts of what an error costs, from passes whose future is known.
#include "common/plan/forecast/forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/policy.h"
#include "common/film/combine.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

/// Variance and cost of a sample with each tree. From tree to tree both change by a power of the step before.
struct Learning {
    double variance = 8, progress = 0.5;
    double seconds = 0.01, growth = 1.3;
    int settled_after = 100;  ///< trees that change anything

    double at(double first, double step, double fading, int tree) const {
        double value = first;
        for (int t = 1; t <= std::min(tree, settled_after); ++t)
            value *= std::pow(step, std::pow(fading, t - 1));
        return value;
    }
    double variance_at(int tree) const { return at(variance, progress, 0.75, tree); }
    double seconds_at(int tree) const { return at(seconds, growth, 0.5, tree); }
};

/// Adds a pass to an inverse-variance render: two threads, adding records takes 20 %, a fixed 0.02 s.
void render_pass(RenderHistory& state, const Learning& world, int tree, std::uint32_t spp, bool record) {
    PassFacts pass;
    pass.spp = spp;
    pass.spp_before = state.spp();
    pass.mse_of_sample = world.variance_at(tree);
    // Keeping a log of records is an eighth of tracing with it.
    pass.trace_core_seconds = 2 * spp * world.seconds_at(tree) / (record ? 0.88 : 1.0);
    pass.record_core_seconds = record ? 0.2 * pass.trace_core_seconds : 0.0;
    pass.collect_seconds = (pass.trace_core_seconds + pass.record_core_seconds) / 2;
    pass.overhead_seconds = 0.02;
    pass.record = record;
    pass.next_event = true;
    const double precision =
        (state.error.known ? 1 / state.error.mse() : 0) +
        (spp >= tuned<std::uint32_t>("schedule.least_weighed_spp") ? spp / pass.mse_of_sample : 0.0);
    state.passes.push_back(pass);
    state.seconds += pass.collect_seconds + pass.overhead_seconds;
    state.error.known = state.error.has_interval = precision > 0;
    state.error.rmse = precision > 0 ? 1 / std::sqrt(precision) : 0;
    state.error.low = 0.97 * state.error.rmse;
    state.error.high = 1.03 * state.error.rmse;
    state.error.mean = 2;
}

RenderHistory rendered(const Learning& world, int passes) {
    RenderHistory state;
    for (int k = 0; k < passes; ++k)
        render_pass(state, world, k, 1u << k, true);
    return state;
}

/// Seconds that it takes to come down to half the error, passes doubling while they teach.
double seconds_to_half(RenderHistory state, const Learning& world) {
    const double target = 0.25 * state.error.mse(), began = state.seconds;
    for (;;) {
        const int tree = static_cast<int>(state.passes.size());
        const double wanted = world.variance_at(tree) * (1 / target - 1 / state.error.mse());
        const bool ends = wanted < 3 * std::ldexp(1.0, tree);
        render_pass(state, world, tree, ends ? static_cast<std::uint32_t>(std::ceil(wanted)) : 1u << tree, !ends);
        if (ends) return state.seconds - began;
    }
}

ErrorForecast halving(const RenderHistory& state, const Job& job = {}) {
    return forecast_error(state, test::resolved(job), 0.5 * state.error.relative());
}

TEST(Forecast, SeesThatTreesStillLearn) {
    for (const double progress : {0.8, 0.9})
        for (const double growth : {0.8, 1.0, 1.25}) {
            const Learning world{.progress = progress, .growth = growth};
            for (const int passes : {4, 5, 7}) {
                const RenderHistory state = rendered(world, passes);
                const ErrorForecast forecast = halving(state);
                EXPECT_EQ(forecast.trust, Trust::firm);
                EXPECT_NEAR(forecast.seconds / seconds_to_half(state, world), 1.0, 0.05)
                    << progress << ", " << growth << ", " << passes << " passes";
            }
        }
}

TEST(Forecast, IsABoundWhileLittleIsLearned) {
    const Learning world{.progress = 0.2, .growth = 1.0};
    const RenderHistory state = rendered(world, 4);
    const ErrorForecast forecast = halving(state);
    EXPECT_EQ(forecast.trust, Trust::learning);
    EXPECT_GE(forecast.seconds, seconds_to_half(state, world));
    EXPECT_EQ(halving(rendered(world, 9)).trust, Trust::firm);
}

TEST(Forecast, ASingleTreeTellsNothingOfTheNext) {
    EXPECT_EQ(halving(rendered({.progress = 1.0}, 3)).trust, Trust::learning);
    EXPECT_EQ(halving(rendered({.progress = 1.0}, 4)).trust, Trust::firm);
}

TEST(Forecast, IsNotTrustedWhereTheErrorIsNot) {
    RenderHistory state = rendered({.progress = 1.0, .growth = 1.0}, 5);
    state.error.high = 1.5 * state.error.rmse;
    EXPECT_EQ(halving(state).trust, Trust::noisy);
    state.error.has_interval = false;
    EXPECT_EQ(halving(state).trust, Trust::noisy);
}

TEST(Forecast, IsRoughWhereItIsFarAhead) {
    const RenderHistory state = rendered({.progress = 1.0, .growth = 1.0}, 5);
    EXPECT_EQ(forecast_error(state, test::resolved({}), 0.3 * state.error.relative()).trust, Trust::firm);
    EXPECT_EQ(forecast_error(state, test::resolved({}), 0.2 * state.error.relative()).trust, Trust::noisy);
}

TEST(Forecast, IsUnknownBeforeThereAreVariances) {
    const ErrorForecast forecast = halving(rendered({}, 1));
    EXPECT_EQ(forecast.trust, Trust::none);
    EXPECT_TRUE(std::isinf(forecast.spp));
    EXPECT_TRUE(std::isinf(forecast.seconds));
}

TEST(Forecast, IsUnknownWhereNextEventIsAboutToEnd) {
    Job job;
    job.integrator.next_event = NextEvent::kickstart;
    EXPECT_EQ(halving(rendered({.progress = 0.9}, 7), job).trust, Trust::firm) << "127 spp are done";
    EXPECT_EQ(halving(rendered({.progress = 0.9}, 8), job).trust, Trust::none) << "255";
}

TEST(Forecast, OfADoneRenderGoesOnWithItsTree) {
    const Learning world{.progress = 0.5};
    RenderHistory state = rendered(world, 5);
    render_pass(state, world, 5, 64, false);
    const ErrorForecast forecast = halving(state);
    EXPECT_EQ(forecast.trust, Trust::firm) << "nothing is learned any more";
    EXPECT_NEAR(forecast.spp, world.variance_at(5) * 3 / state.error.mse(), 1.0);
    EXPECT_NEAR(forecast.seconds, forecast.spp * world.seconds_at(5) + 0.02, 1e-6);
}

TEST(Forecast, OfTheErrorAskedForKnowsThatRendersEndALittleBeyondIt) {
    const RenderHistory state = rendered({.progress = 1.0, .growth = 1.0}, 6);
    Job job;
    job.budget.error = 0.9 * state.error.relative();
    EXPECT_NEAR(forecast_error(state, test::resolved(job), job.budget.error).spp /
                    forecast_error(state, test::resolved({}), job.budget.error).spp,
                1.02, 1e-9);
}

TEST(Forecast, IsNothingWhereTheErrorIsReached) {
    const RenderHistory state = rendered({}, 5);
    EXPECT_EQ(forecast_error(state, test::resolved({}), 2 * state.error.relative()).seconds, 0);
}

TEST(Forecast, OfTheLastTreeKeepsWhatItHas) {
    const Learning world{.progress = 1, .growth = 1};
    Job job;
    job.guiding.combination = Combination::last;
    RenderHistory state = rendered(world, 5);
    render_pass(state, world, 5, 30, false);
    render_pass(state, world, 5, 10, false);
    state.error.rmse = std::sqrt(8.0 / 40);
    EXPECT_DOUBLE_EQ(halving(state, job).spp, 3 * 40);
    job.budget.strict = true;
    EXPECT_DOUBLE_EQ(halving(state, job).spp, 4 * 40) << "what a strict render has, it will not show";
}

TEST(Outlook, ATreeThatBringsNothingAfterOneThatBroughtMuchIsNotBelieved) {
    RenderHistory state = rendered({.progress = 1, .growth = 1}, 6);
    state.passes[5].mse_of_sample = state.passes[4].mse_of_sample = 3;
    state.passes[3].mse_of_sample = 6;
    EXPECT_EQ(Outlook(state).recent_progress(), 0.5);
    EXPECT_EQ(halving(state).trust, Trust::learning);
    state.passes[3].mse_of_sample = 4;
    EXPECT_EQ(halving(state).trust, Trust::firm);
}

TEST(Outlook, NoiseInMeasuredVariancesIsNoProgress) {
    RenderHistory state = rendered({.progress = 1, .growth = 1}, 6);
    state.passes[4].mse_of_sample = 4;
    state.passes[5].mse_of_sample = 6;  // more than with the tree before: they are alike
    const Outlook outlook(state);
    EXPECT_DOUBLE_EQ(outlook.variance(), (16 * 4.0 + 32 * 6.0) / 48);
    EXPECT_LT(outlook.progress(), 0.75) << "what was learned two trees before may go on";
    state.passes[3].mse_of_sample = 4;
    EXPECT_EQ(Outlook(state).progress(), 1) << "three trees, none better than that before";
    EXPECT_EQ(Outlook(state).variance_after(5), Outlook(state).variance());
}

TEST(Outlook, RareSamplesInAPassAreNoNews) {
    RenderHistory state = rendered({.progress = 1, .growth = 1}, 6);
    for (PassFacts& pass : state.passes)
        pass.stuv_trimmed = 0.5 * pass.mse_of_sample;
    state.passes[3].mse_of_sample *= 3;  // a pass that found some
    const Outlook outlook(state);
    EXPECT_EQ(outlook.progress(), 1);
    const double worst = (2 + 4 + 3 * 8 + 16 + 32) / 62.0;
    EXPECT_DOUBLE_EQ(outlook.variance(), 8 * worst) << "they count for all trees";
    state.passes[5].stuv_trimmed *= 0.9;
    EXPECT_NEAR(Outlook(state).progress(), 0.9, 1e-9);
}

TEST(Outlook, TheClockIsTheMeanOfAllPasses) {
    RenderHistory state = rendered({.progress = 1, .growth = 1}, 7);
    state.passes.back().collect_seconds *= 2;  // a neighbour came, for 64 of 127 spp
    EXPECT_NEAR(Outlook(state).seconds_per_spp(0, false), 0.01 * (63 + 2 * 64) / 127, 1e-9);
    render_pass(state, {.growth = 1}, 7, 2, false);
    EXPECT_NEAR(Outlook(state).seconds_per_spp(0, false), 0.015, 1e-4) << "a small pass tells little";
}

/// Passes of a farm tell of another one by their threads, until it has a pass of its own.
TEST(Outlook, OtherThreadsTakeOtherTimes) {
    RenderHistory state = rendered({.progress = 1, .growth = 1}, 6);
    for (PassFacts& pass : state.passes)
        pass.threads = 2;
    for (const auto& [threads, seconds] : {std::pair(0u, 0.01), {2u, 0.01}, {8u, 0.0025}, {1u, 0.02}}) {
        state.threads = threads;
        EXPECT_NEAR(Outlook(state).seconds_per_spp(0, false), seconds, 1e-12) << threads;
    }
    render_pass(state, {.progress = 1, .growth = 1}, 6, 64, true);
    state.threads = state.passes.back().threads = 8;
    state.passes.back().collect_seconds /= 3;  // eight are as fast as six
    EXPECT_NEAR(Outlook(state).seconds_per_spp(0, false), 0.01 / 3, 1e-12);
    state.threads = 2;
    EXPECT_NEAR(Outlook(state).seconds_per_spp(0, false), 0.01, 1e-12) << "back where it began";
    for (PassFacts& pass : state.passes)
        pass.threads = 40;
    state.threads = 42;
    EXPECT_NEAR(Outlook(state).seconds_per_spp(0, false), 0.01 * (63 + 64 / 3.0) / 127, 1e-9) << "about as many";
}

TEST(Outlook, RecordingIsSeenApart) {
    const Outlook outlook(rendered({.progress = 1, .growth = 1}, 6));
    EXPECT_NEAR(outlook.seconds_per_spp(0, false), 0.01, 1e-9);
    EXPECT_NEAR(outlook.seconds_per_spp(0, true), 0.01 * 1.2 / 0.88, 1e-9);
}

/// The error that a render is in after one more pass, weighed as combine_passes does.
double error_after(const RenderHistory& state, const Job& job, double spp, double variance) {
    const double now = state.error.mse();
    if (job.budget.strict) return std::sqrt(variance / spp);
    if (job.guiding.combination == Combination::inverse_variance && job.guiding.type != GuidingType::none)
        return std::sqrt(1 / (1 / now + spp / variance));
    const bool guided = job.guiding.type != GuidingType::none;
    double sum = 0;
    for (const PassFacts& pass : state.passes)
        sum += fixed_weight(pass.spp, pass.spp_before, guided);
    const double weight = spp * fixed_weight(1, state.spp(), guided);
    return std::sqrt((sum * sum * now + weight * weight * variance / spp) / ((sum + weight) * (sum + weight)));
}

TEST(SppToReach, LeadsToTheErrorAskedFor) {
    RenderHistory state = rendered({}, 5);
    for (const bool strict : {false, true})
        for (const GuidingType type : {GuidingType::none, GuidingType::ppg})
            for (const Combination combination : {Combination::fixed, Combination::inverse_variance}) {
                Job job;
                job.guiding.type = type;
                job.guiding.combination = combination;
                job.budget.strict = strict;
                // Without guiding, all samples are alike: the error says what one of them is worth.
                state.error.rmse = type == GuidingType::none ? std::sqrt(4.0 / 31) : 0.35;
                const double spp = spp_to_reach(state, test::resolved(job), 0.1 * 0.1, 4.0);
                EXPECT_NEAR(error_after(state, job, spp, 4.0), 0.1, 1e-9);
            }
}

}  // namespace
}  // namespace treefarm
