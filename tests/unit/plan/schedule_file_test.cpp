// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/schedule_file.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/refusal.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

Job job_with(NextEvent next_event) {
    Job job;
    job.budget.spp = 300;
    job.integrator.next_event = next_event;
    return job;
}

std::string message_of(const std::string& text, const Job& job = {}) {
    return test::refusal_of([&] { parse_schedule(text, "s.toml", test::resolved(job)); });
}

TEST(ScheduleFile, ComesBackAsItWasWritten) {
    for (const NextEvent next_event : {NextEvent::always, NextEvent::never, NextEvent::kickstart}) {
        const Job job = job_with(next_event);
        std::vector<PassPlan> passes = plan_passes(test::resolved(job));
        passes[4].split = false;
        const std::vector<PassPlan> back = parse_schedule(write_schedule(passes), "s.toml", test::resolved(job));
        ASSERT_EQ(back.size(), passes.size());
        for (std::size_t k = 0; k < passes.size(); ++k)
            EXPECT_EQ(back[k], passes[k]) << "pass " << k;
    }
}

TEST(ScheduleFile, SaysWhereItIsWrong) {
    const std::string good = "[[pass]]\nspp = 4\nnext_event = true\nrecord = true\n";
    EXPECT_EQ(message_of(good), "");
    EXPECT_EQ(message_of("[[pass]]\nspp = 0\nnext_event = true\nrecord = true\n"),
              "s.toml:2:7: spp is not an integer of at least 1, up to 2^30 in all; "
              "write the samples per pixel of this pass");
    EXPECT_EQ(message_of(good + "[[pass]]\nspp = 1073741821\nnext_event = true\nrecord = true\n").substr(0, 11),
              "s.toml:6:7:");
    EXPECT_EQ(message_of("[[pass]]\nspp = 4.0\nnext_event = true\nrecord = true\n").substr(0, 11), "s.toml:2:7:");
    EXPECT_EQ(message_of("[[pass]]\nspp = 4\nnext_event = 1\nrecord = true\n").substr(0, 12), "s.toml:3:14:");
    EXPECT_EQ(message_of("[[pass]]\nspp = 4\nnext_event = true\n").substr(0, 11), "s.toml:1:1:");
    EXPECT_EQ(message_of(good + "seed = 3\n").substr(0, 11), "s.toml:5:1:");
    EXPECT_EQ(message_of("passes = 3\n").substr(0, 11), "s.toml:1:1:");
    EXPECT_EQ(message_of("pass = 3\n").substr(0, 11), "s.toml:1:8:");
    EXPECT_EQ(message_of("pass = [3]\n").substr(0, 11), "s.toml:1:9:");
    EXPECT_EQ(message_of("[[pass]\n").substr(0, 9), "s.toml:1:");
    EXPECT_EQ(message_of("").substr(0, 11), "s.toml:1:1:");
}

TEST(ScheduleFile, MustFitTheJob) {
    Job unguided;
    unguided.guiding.type = GuidingType::none;
    EXPECT_EQ(message_of("[[pass]]\nspp = 4\nnext_event = true\nrecord = true\n", unguided).substr(0, 12),
              "s.toml:4:10:");
    EXPECT_EQ(message_of("[[pass]]\nspp = 4\nnext_event = true\nrecord = false\n", unguided), "");
}

}  // namespace
}  // namespace treefarm
