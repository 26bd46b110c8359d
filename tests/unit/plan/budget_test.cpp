// SPDX-License-Identifier: Apache-2.0
// Open budgets against simulated renders: a clock and an error that follow a rule.
#include "common/plan/forecast/budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/policy.h"
#include "common/film/combine.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

/// How long passes take and how noisy they are.
struct World {
    double seconds_per_spp = 0.01;
    double overhead = 0.02;            ///< of a pass
    double variance = 4.0;             ///< of one sample
    double learning = 1.0;             ///< variance falls by this factor with each pass
    double slow_from = 1e9, slow = 1;  ///< from this second on a sample takes so much longer
    double growth = 1.0;               ///< by which a sample's cost changes with the first tree, then ever less
    double threads = 2;
    double moves_at = 1e9, moves_to = 2;  ///< from this second on the render goes on with so many threads
};

/// Core-seconds of a sample with a tree that was learned in so many passes.
double core_per_spp(const World& world, std::uint32_t trees) {
    return world.threads * world.seconds_per_spp * std::pow(world.growth, 2 - std::pow(0.5, trees));
}

/// Facts about a simulated pass; adding records takes a tenth of the time.
PassFacts facts_of(const PassPlan& pass, const World& world, std::uint32_t trees, double speed, double threads) {
    PassFacts facts;
    facts.spp = pass.spp;
    facts.spp_before = pass.first_sample;
    facts.mse_of_sample = world.variance * std::pow(world.learning, trees);
    facts.trace_core_seconds = pass.spp * core_per_spp(world, trees);
    facts.record_core_seconds = pass.record ? 0.1 * facts.trace_core_seconds : 0.0;
    facts.collect_seconds = speed * (facts.trace_core_seconds + facts.record_core_seconds) / threads;
    facts.threads = static_cast<std::uint32_t>(threads);
    facts.overhead_seconds = world.overhead;
    facts.record = pass.record;
    facts.next_event = pass.next_event;
    return facts;
}

struct Simulated {
    std::vector<PassPlan> passes;
    RenderHistory state;
    std::vector<ErrorForecast> forecasts;  ///< of budget.error, after each pass
};

Simulated simulate(const Job& job, const World& world) {
    Simulated run;
    const PassChooser choose = passes_of(test::resolved(job));
    double precision = 0;
    std::uint32_t trees = 0;
    for (NextPass next = choose(run.state); next.pass; next = choose(run.state)) {
        const PassPlan* const pass = &*next.pass;
        run.state.budget = next.memory;
        EXPECT_LT(run.passes.size(), 100u) << "the budget does not end";
        if (run.passes.size() >= 100) break;
        RenderHistory& state = run.state;
        const double speed = state.seconds >= world.slow_from ? world.slow : 1.0;
        const bool same_tree = !state.passes.empty() && !state.passes.back().record;
        trees += !state.passes.empty() && !same_tree;
        const double threads = state.seconds >= world.moves_at ? world.moves_to : world.threads;
        const PassFacts facts = facts_of(*pass, world, trees, speed, threads);
        state.passes.push_back(facts);
        state.seconds += facts.collect_seconds + world.overhead;
        state.threads = static_cast<std::uint32_t>(state.seconds >= world.moves_at ? world.moves_to : world.threads);
        const bool counts =
            job.guiding.type == GuidingType::none || pass->spp >= tuned<std::uint32_t>("schedule.least_weighed_spp");
        if (job.budget.strict || (shows_last_tree_only(test::resolved(job)) && !same_tree)) precision = 0;
        if (counts) precision += pass->spp / facts.mse_of_sample;
        state.error.known = precision > 0;
        state.error.rmse = precision > 0 ? std::sqrt(1 / precision) : 0;
        state.error.low = 0.9 * state.error.rmse;
        state.error.mean = 0.5;
        run.passes.push_back(*pass);
        run.forecasts.push_back(forecast_error(state, test::resolved(job), job.budget.error));
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

TEST(FinishedPass, KnowsItsTreeAndWhetherNextEventEnded) {
    Job job;
    job.integrator.next_event = NextEvent::kickstart;
    const PassPlan teaching = make_pass(test::resolved(job), 6, 63, 64, false),
                   kickstart = make_pass(test::resolved(job), 7, 127, 10, true),
                   after = make_pass(test::resolved(job), 8, 137, 10, true);
    const PassResult first = finished_pass(teaching, nullptr, {});
    EXPECT_FALSE(first.same_tree || first.new_technique);
    const PassResult of_new_tree = finished_pass(kickstart, &teaching, {});
    EXPECT_FALSE(of_new_tree.same_tree || of_new_tree.new_technique);
    const PassResult unaided = finished_pass(after, &kickstart, {});
    EXPECT_TRUE(unaided.same_tree && unaided.new_technique);
    EXPECT_TRUE(unaided.guided);
    PassPlan given_up = after;
    given_up.guided = false;
    EXPECT_FALSE(finished_pass(given_up, &after, {}).guided);
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

/// A budget of half a second had a tolerance of a whole one: the render ended at a quarter of it.
TEST(Budget, AShortRenderUsesWhatItWasGranted) {
    for (const double seconds : {0.3, 0.5, 0.7, 2.0})
        for (const double per_spp : {0.0005, 0.002, 0.01})
            for (const GuidingType type : {GuidingType::none, GuidingType::automatic}) {
                Job job = seconds_job(seconds);
                job.guiding.type = type;
                const Simulated run = simulate(job, {.seconds_per_spp = per_spp, .overhead = 0.001});
                EXPECT_NEAR(run.state.seconds, seconds, 0.1 * seconds) << per_spp << " s per sample";
            }
}

TEST(Budget, SecondsAreKeptWhenSamplesBecomeDearer) {
    for (const double slow : {0.7, 1.35})
        for (const double from : {2.0, 8.0, 14.0}) {
            const Simulated run = simulate(seconds_job(30), {.slow_from = from, .slow = slow});
            EXPECT_LT(distance(run, 30), 1.0) << "from second " << from << " on, " << slow;
        }
}

/// A pass of a life with fewer threads was as long as one with those before would have been, times their ratio.
TEST(Budget, SecondsAreKeptWhenARenderGoesOnWithOtherThreads) {
    for (const double threads : {1.0, 3.0, 7.0, 9.0, 64.0})
        for (const double at : {2.0, 9.0, 20.0}) {
            const Simulated run = simulate(seconds_job(60), {.threads = 8, .moves_at = at, .moves_to = threads});
            EXPECT_LT(distance(run, 60), 1.0)
                << threads << " threads from second " << at << " on, " << run.state.seconds;
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
        EXPECT_EQ(pass.record, pass.index + 2 < run.passes.size()) << "one with the last tree to learn what it costs";
    const double thrown_away = run.passes[run.passes.size() - 2].spp;
    EXPECT_LT(thrown_away, 0.1 * run.passes.back().spp);
}

TEST(Budget, AStrictRenderKeepsItsTimeWhereTreesMakeSamplesDearer) {
    for (const double growth : {0.6, 0.8, 1.3, 1.6}) {
        Job job = seconds_job(10);
        job.budget.strict = true;
        EXPECT_LT(distance(simulate(job, {.seconds_per_spp = 0.02, .growth = growth}), 10), 1.0) << growth;
    }
}

TEST(Budget, PassesOfTheLastTreeMakeUpForAWrongForecast) {
    Job job = seconds_job(10);
    job.guiding.combination = Combination::last;
    const Simulated run = simulate(job, {.seconds_per_spp = 0.02, .slow_from = 4, .slow = 0.8});
    EXPECT_LT(distance(run, 10), 1.0);
    EXPECT_GT(run.state.spp_of_last_tree(), run.passes.back().spp);
}

TEST(Budget, AStrictRenderOfAnErrorThrowsNothingAway) {
    Job job = error_job(0.1);
    job.budget.strict = true;
    const Simulated run = simulate(job, {});
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

TEST(Budget, TheForecastOfAnErrorSaysWhatWillBeDone) {
    for (const bool strict : {false, true})
        for (const double target : {0.1, 0.03}) {
            Job job = error_job(target);
            job.budget.strict = strict;
            const Simulated run = simulate(job, {});
            const double total = run.state.spp();
            for (std::size_t k = 4; k + 1 < run.passes.size(); ++k) {
                const double done = run.passes[k].first_sample + run.passes[k].spp;
                EXPECT_NEAR((done + run.forecasts[k].spp) / total, 1.0, 0.02) << k << (strict ? ", strict" : "");
            }
        }
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

TEST(Budget, OnlyWhatTheJobShowsIsKept) {
    const auto shown = [](const Job& job) {
        std::vector<PassResult> passes;
        for (const bool same_tree : {false, false, true})
            show({4, 0, {}, same_tree}, test::resolved(job), passes);
        return passes.size();
    };
    Job job;
    EXPECT_EQ(shown(job), 3u);
    job.guiding.combination = Combination::last;
    EXPECT_EQ(shown(job), 2u);
    job.budget.strict = true;
    EXPECT_EQ(shown(job), 1u);
    job = {};
    job.guiding.type = GuidingType::none;
    job.guiding.combination = Combination::last;
    EXPECT_EQ(shown(job), 3u);
}

TEST(Budget, AListIsPlayedAsItIs) {
    Job job;
    job.guiding.type = GuidingType::ppg;
    job.budget.spp = 100;
    const std::vector<PassPlan> passes = plan_passes(test::resolved(job));
    EXPECT_EQ(simulate(job, {}).passes, passes);
}

}  // namespace
}  // namespace treefarm
