// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/schedule.h"

#include <gtest/gtest.h>

#include "common/film/work_unit.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

std::vector<std::uint32_t> pass_spp(std::uint32_t budget, int unit) {
    Job job;
    job.budget.spp = budget;
    job.guiding.spp_unit = unit;
    std::vector<std::uint32_t> spp;
    for (const PassPlan& pass : plan_passes(test::resolved(job)))
        spp.push_back(pass.spp);
    return spp;
}

TEST(Schedule, DoublesAndGivesTheRestToTheLastPass) {
    EXPECT_EQ(pass_spp(127, 4), (std::vector<std::uint32_t>{4, 8, 16, 32, 68}));
    EXPECT_EQ(pass_spp(127, 1), (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32, 64}));
    EXPECT_EQ(pass_spp(1, 4), (std::vector<std::uint32_t>{4}));
    EXPECT_EQ(pass_spp(5, 1), (std::vector<std::uint32_t>{1, 4}));
}

TEST(Schedule, OfZeroSamplesHasNoPasses) {
    EXPECT_TRUE(pass_spp(0, 4).empty());
}

TEST(Schedule, OnlyTheLastPassDoesNotRecord) {
    Job job;
    job.budget.spp = 60;
    const auto passes = plan_passes(test::resolved(job));
    for (const PassPlan& pass : passes)
        EXPECT_EQ(pass.record, pass.index + 1 < passes.size());
    job.guiding.type = GuidingType::none;
    for (const PassPlan& pass : plan_passes(test::resolved(job)))
        EXPECT_FALSE(pass.record);
}

TEST(Schedule, KickstartEndsAt128Samples) {
    Job job;
    job.budget.spp = 1023;
    job.guiding.spp_unit = 1;
    job.integrator.next_event = NextEvent::kickstart;
    for (const PassPlan& pass : plan_passes(test::resolved(job))) {
        EXPECT_EQ(pass.next_event, pass.first_sample < 128);
        EXPECT_EQ(pass.record_weight, pass.next_event ? 0.5 : 1.0);
    }
}

TEST(Schedule, ChunksCoverEveryBlockOnce) {
    for (const int tile : {8, 32, 50, 256})
        for (const std::uint32_t spp : {1u, 64u, 65u, 1000u, 100000u}) {
            Job job;
            job.budget.spp = spp;
            job.guiding.type = GuidingType::none;
            job.farm.tile_size = tile;
            for (const PassPlan& pass : plan_passes(test::resolved(job))) {
                const std::uint32_t blocks = (pass.spp + kBlockSamples - 1) / kBlockSamples;
                EXPECT_EQ(pass.blocks_per_unit & (pass.blocks_per_unit - 1), 0u);
                EXPECT_GE(pass.chunks * pass.blocks_per_unit, blocks);
                EXPECT_LT((pass.chunks - 1) * pass.blocks_per_unit, blocks);
            }
        }
}

TEST(Schedule, SplitThresholdFollowsTheNominalPass) {
    Job job;
    job.guiding.spp_unit = 4;
    job.guiding.spatial_threshold = 12000;
    PassPlan pass;
    pass.index = 4;
    pass.spp = 68;  // the extended last pass of 127 spp counts as 64
    EXPECT_DOUBLE_EQ(spatial_split_threshold(test::resolved(job), pass), 48000.0);

    job.guiding.spatial_threshold = 0;
    EXPECT_DOUBLE_EQ(spatial_split_threshold(test::resolved(job), pass), 8000.0);
    SceneFacts small;
    small.film_pixels = 128 * 128;
    EXPECT_DOUBLE_EQ(spatial_split_threshold(resolve(job, small), pass), 4000.0);
}

}  // namespace
}  // namespace treefarm
