// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/plan/forecast/budget.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

Resolved job_of(std::uint32_t spp, int unit = 1, GuidingType type = GuidingType::ppg) {
    Job job;
    job.budget.spp = spp;
    job.guiding.spp_unit = unit;
    job.guiding.type = type;
    return test::resolved(job);
}

std::vector<std::uint32_t> lengths(const std::vector<PassPlan>& passes) {
    std::vector<std::uint32_t> spp;
    for (const PassPlan& pass : passes)
        spp.push_back(pass.spp);
    return spp;
}

std::vector<PassPlan> first_of(std::vector<PassPlan> passes, std::size_t count) {
    passes.resize(count);
    return passes;
}

TEST(ContinuedPasses, BeforeAnyTheyAreThoseOfThePlan) {
    EXPECT_EQ(continued_passes(job_of(100), {}), plan_passes(job_of(100)));
}

TEST(ContinuedPasses, OneThatWasBrokenOffGoesOnAsPlanned) {
    const std::vector<PassPlan> plan = plan_passes(job_of(100));
    for (std::size_t done = 0; done <= plan.size(); ++done)
        EXPECT_EQ(continued_passes(job_of(100), first_of(plan, done)), plan) << done;
}

TEST(ContinuedPasses, WithMoreSamplesOneBrokenOffBeforeItsLastPassIsTheLongerRender) {
    const std::vector<PassPlan> begun = first_of(plan_passes(job_of(100)), 5);  // 1 2 4 8 16, all of which teach
    EXPECT_EQ(continued_passes(job_of(1000), begun), plan_passes(job_of(1000)));
}

TEST(ContinuedPasses, OneThatIsDoneGoesOnDoubling) {
    const std::vector<PassPlan> done = plan_passes(job_of(100));
    EXPECT_EQ(lengths(done), (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 69}));
    const std::vector<PassPlan> more = continued_passes(job_of(1000), done);
    EXPECT_EQ(lengths(more), (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 69, 64, 128, 708}));
    EXPECT_EQ(std::vector<PassPlan>(more.begin(), more.begin() + 6), done);
    std::uint32_t first = 0;
    for (std::size_t k = 0; k < more.size(); ++k) {
        EXPECT_EQ(more[k].index, k);
        EXPECT_EQ(more[k].first_sample, first);
        EXPECT_EQ(more[k].record, k + 1 < more.size() && k != 5) << "all that is to come but the last teaches";
        first += more[k].spp;
    }
}

TEST(ContinuedPasses, AFewMoreAreOnePass) {
    const std::vector<PassPlan> more = continued_passes(job_of(120), plan_passes(job_of(100)));
    EXPECT_EQ(lengths(more), (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 69, 20}));
    EXPECT_FALSE(more.back().record);
}

TEST(ContinuedPasses, FewerSamplesThanThereAreAddNone) {
    const std::vector<PassPlan> done = plan_passes(job_of(100));
    EXPECT_EQ(continued_passes(job_of(100), done), done);
    EXPECT_EQ(continued_passes(job_of(50), done), done);
}

TEST(ContinuedPasses, SamplesComeInWholeUnits) {
    const std::vector<PassPlan> more = continued_passes(job_of(130, 4), plan_passes(job_of(100, 4)));
    EXPECT_EQ(more.back().first_sample + more.back().spp, 132u);
    for (const PassPlan& pass : more)
        EXPECT_EQ(pass.spp % 4, 0u);
}

TEST(ContinuedPasses, PassesThatGaveUpGuidingAreThoseOfThePlan) {
    const Resolved job = job_of(1000);
    std::vector<PassPlan> begun = first_of(plan_passes(job), 7);
    begun[6].guided = false;
    set_record(begun[6], job, false);
    EXPECT_EQ(continued_passes(job, begun), plan_passes(job));
}

TEST(ContinuedPasses, WithoutAGuideToo) {
    const std::vector<PassPlan> done = plan_passes(job_of(64, 1, GuidingType::none));
    const std::vector<PassPlan> more = continued_passes(job_of(128, 1, GuidingType::none), done);
    EXPECT_EQ(more.back().first_sample + more.back().spp, 128u);
}

TEST(PassChoice, IsPure) {
    Job asked;
    asked.budget.seconds = 10;
    const Resolved job = test::resolved(asked);
    const PassChooser choose = passes_of(job);
    RenderHistory history;
    for (int k = 0; k < 12; ++k) {
        const NextPass next = choose(history), again = choose(history), elsewhere = passes_of(job)(history);
        EXPECT_EQ(next.pass, again.pass);
        EXPECT_EQ(next.pass, elsewhere.pass);
        EXPECT_EQ(next.memory, elsewhere.memory);
        if (!next.pass) break;
        PassFacts facts;
        facts.spp = next.pass->spp;
        facts.spp_before = next.pass->first_sample;
        facts.mse_of_sample = facts.stuv_trimmed = 1;
        facts.collect_seconds = facts.trace_core_seconds = 0.01 * facts.spp;
        facts.record = next.pass->record;
        history.passes.push_back(facts);
        history.seconds += facts.collect_seconds;
        history.error.known = true;
        history.error.mean = history.error.rmse = 1;
        history.budget = next.memory;
    }
    EXPECT_TRUE(history.budget.ending);
}

}  // namespace
}  // namespace treefarm
