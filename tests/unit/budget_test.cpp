// Open budgets against simulated renders: a clock and an error that follow a rule.
#include "common/plan/budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/film/combine.h"

namespace treefarm {
namespace {

/// How long passes take and how noisy they are.
struct World {
    double seconds_per_spp = 0.01;
    double overhead = 0.02;            ///< of a pass
    double variance = 4.0;             ///< of one sample
    double learning = 1.0;             ///< variance falls by this factor with each pass
    double slow_from = 1e9, slow = 1;  ///< from this second on a sample takes so much longer
};

struct Simulated {
    std::vector<PassPlan> passes;
    RenderState state;
};

Simulated simulate(const Job& job, const World& world) {
    Simulated run;
    const PassChooser choose = passes_of(job);
    double precision = 0;
    while (const auto pass = choose(run.state).pass) {
        EXPECT_LT(run.passes.size(), 100u) << "the budget does not end";
        if (run.passes.size() >= 100) break;
        RenderState& state = run.state;
        const double v = world.variance * std::pow(world.learning, pass->index);
        const double speed = state.seconds >= world.slow_from ? world.slow : 1.0;
        const double trace = world.seconds_per_spp * speed * pass->spp;
        state.passes.push_back({pass->spp, state.spp(), v, trace, world.overhead});
        state.seconds += trace + world.overhead;
        const bool counts = job.guiding.type == GuidingType::none || pass->spp >= kMinSamplesForVariance;
        if (shows_last_pass_only(job)) precision = 0;
        if (counts) precision += pass->spp / v;
        state.error.known = precision > 0;
        state.error.rmse = precision > 0 ? std::sqrt(1 / precision) : 0;
        state.error.low = 0.9 * state.error.rmse;
        state.error.mean = 0.5;
        run.passes.push_back(*pass);
    }
    return run;
}

Job seconds_job(double seconds) {
    Job job;
    job.budget.seconds = seconds;
    job.budget.max_spp = 1u << 30;
    return job;
}

Job error_job(double error) {
    Job job;
    job.budget.error = error;
    return job;
}

double distance(const Simulated& run, double seconds) {
    return std::abs(run.state.seconds - seconds) / std::max(0.05 * seconds, 1.0);
}

TEST(Budget, SecondsAreKept) {
    for (const double seconds : {1.0, 5.0, 10.0, 60.0, 600.0})
        for (const double per_spp : {0.0005, 0.01, 0.2})
            for (const GuidingType type : {GuidingType::none, GuidingType::ppg}) {
                Job job = seconds_job(seconds);
                job.guiding.type = type;
                const Simulated run = simulate(job, {.seconds_per_spp = per_spp});
                EXPECT_LT(distance(run, seconds), 1.0) << seconds << " s, " << per_spp << " s per sample";
            }
}

TEST(Budget, SecondsAreKeptWhenSamplesBecomeDearer) {
    for (const double slow : {0.8, 1.25})
        for (const double from : {2.0, 8.0, 14.0}) {
            const Simulated run = simulate(seconds_job(30), {.slow_from = from, .slow = slow});
            EXPECT_LT(distance(run, 30), 1.0) << "from second " << from << " on, " << slow;
        }
}

TEST(Budget, SecondsAreKeptWhenOnlyAFewSamplesFit) {
    for (const double per_spp : {0.3, 0.5, 0.7, 0.9})
        EXPECT_LT(distance(simulate(seconds_job(10), {.seconds_per_spp = per_spp}), 10), 1.0) << per_spp;
}

TEST(Budget, AStrictRenderHasOneEndingPass) {
    Job job = seconds_job(30);
    job.budget.strict = true;
    const Simulated run = simulate(job, {});
    EXPECT_LT(distance(run, 30), 1.0);
    for (const PassPlan& pass : run.passes)
        EXPECT_EQ(pass.record, pass.index + 1 < run.passes.size());
}

TEST(Budget, AtLeastOnePassIsRendered) {
    EXPECT_EQ(simulate(seconds_job(0.001), {.seconds_per_spp = 5}).passes.size(), 1u);
}

TEST(Budget, PassesDoubleWhileTheyLearn) {
    const Simulated run = simulate(seconds_job(60), {});
    std::uint32_t spp = 1, done = 0;
    for (const PassPlan& pass : run.passes) {
        EXPECT_EQ(pass.first_sample, done);
        done += pass.spp;
        if (!pass.record) continue;
        EXPECT_EQ(pass.spp, spp);
        spp *= 2;
    }
    EXPECT_FALSE(run.passes.back().record);
    EXPECT_GE(done, 4 * spp / 2) << "the ending passes take at least half";
}

TEST(Budget, AnErrorIsReachedAndNotOverdone) {
    for (const double target : {0.5, 0.1, 0.03})
        for (const double learning : {1.0, 0.8})
            for (const GuidingType type : {GuidingType::none, GuidingType::ppg}) {
                Job job = error_job(target);
                job.guiding.type = type;
                const Simulated run = simulate(job, {.learning = learning});
                EXPECT_LE(run.state.error.relative(), target);
                EXPECT_FALSE(misses_target(job, run.state.error));
                // At the variance of the last training pass; a finer target leaves less room for doubling's steps.
                if (target < 0.2 && learning == 1.0) {
                    EXPECT_GT(run.state.error.relative(), 0.9 * target);
                }
            }
}

TEST(Budget, TooFewSamplesAreNotBelieved) {
    EXPECT_GE(simulate(error_job(10), {}).state.spp(), 16u);
    EXPECT_GE(simulate(error_job(10), {.variance = 0}).state.spp(), 16u);
}

TEST(Budget, AStrictErrorIsForecast) {
    Job job = error_job(0.1);
    job.budget.strict = true;
    const Simulated run = simulate(job, {});
    EXPECT_LE(run.state.error.relative(), 0.1);
    EXPECT_GT(run.state.error.relative(), 0.09);
    EXPECT_FALSE(run.passes.back().record);
}

TEST(Budget, AStrictRenderNeverReturnsAPassThatItLookedAt) {
    Job job = error_job(5.0);  // any pass will do
    job.budget.strict = true;
    const Simulated run = simulate(job, {});
    EXPECT_FALSE(run.passes.back().record);
}

TEST(Budget, WhatCannotBeReachedEndsAtMaxSpp) {
    Job job = error_job(1e-6);
    job.budget.max_spp = 1000;
    const Simulated run = simulate(job, {});
    EXPECT_EQ(run.state.spp(), 1000u);
    EXPECT_TRUE(misses_target(job, run.state.error));
}

TEST(Budget, WhicheverComesFirst) {
    Job job = error_job(0.01);
    job.budget.seconds = 10;
    const Simulated in_time = simulate(job, {});
    EXPECT_LT(distance(in_time, 10), 1.0);
    EXPECT_TRUE(misses_target(job, in_time.state.error));
    job.budget.error = 0.2;
    EXPECT_LT(simulate(job, {}).state.seconds, 9);
}

TEST(Budget, AListIsPlayedAsItIs) {
    Job job;
    job.budget.spp = 100;
    const std::vector<PassPlan> passes = plan_passes(job);
    EXPECT_EQ(simulate(job, {}).passes, passes);
}

/// The error that a render is in after one more pass, weighed as combine_passes does.
double error_after(const RenderState& state, const Job& job, double spp, double variance) {
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

TEST(Forecast, LeadsToTheErrorAskedFor) {
    RenderState state;
    state.passes = {{1, 0, 0, 0.1, 0.1}, {8, 1, 5.0, 0.8, 0.1}, {16, 9, 4.0, 1.6, 0.1}};
    state.error.known = true;
    state.error.mean = 2;
    for (const bool strict : {false, true})
        for (const GuidingType type : {GuidingType::none, GuidingType::ppg})
            for (const Combination combination : {Combination::fixed, Combination::inverse_variance}) {
                Job job;
                job.guiding.type = type;
                job.guiding.combination = combination;
                job.budget.strict = strict;
                // Without guiding, all samples are alike: the error says what one of them is worth.
                state.error.rmse = type == GuidingType::none ? std::sqrt(4.0 / 25) : 0.35;
                const double spp = spp_to_reach(state, job, 0.1 * 0.1);
                EXPECT_NEAR(error_after(state, job, spp, 4.0), 0.1, 1e-9);
            }
}

TEST(Forecast, OfTimeIsThatOfTheLastPasses) {
    RenderState state;
    state.passes = {{64, 0, 1, 1.0, 0.5}, {128, 64, 1, 4.0, 0.25}};
    EXPECT_DOUBLE_EQ(seconds_of_pass(state, 256), 0.25 + 8.0);
    state.passes.push_back({4, 192, 1, 1.0, 0.25});  // too small a pass to go by alone
    EXPECT_DOUBLE_EQ(seconds_per_spp(state), 5.0 / 132);
}

TEST(Forecast, IsUnknownBeforeThereAreVariances) {
    RenderState state;
    state.passes = {{1, 0, 0, 1.0, 0.1}};
    EXPECT_TRUE(std::isinf(spp_to_reach(state, {}, 1)));
}

}  // namespace
}  // namespace treefarm
