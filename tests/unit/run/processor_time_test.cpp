// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/processor_time.h"

#include <gtest/gtest.h>

#include "coordinator/passes/pass_report.h"

namespace treefarm {
namespace {

TEST(ProcessorTime, AStarvedWorkerIsToldOnce) {
    ProcessorTime starved;
    EXPECT_EQ(starved.add(3, 9.0, 0.5), "") << "too little is known";
    EXPECT_EQ(starved.add(3, 11.0, 0.7),
              "worker 3 had 6 % of its processors: other programs use them, or it has more threads than processors");
    EXPECT_EQ(starved.add(3, 11.0, 0.7), "");
}

TEST(ProcessorTime, WaitingForUnitsIsNoStarving) {
    ProcessorTime idle, shared;
    EXPECT_EQ(idle.add(1, 11.0, 10.9), "");
    EXPECT_EQ(shared.add(2, 100.0, 51.0), "");
}

/// Idle is the time without a unit: threads without a processor are not.
TEST(ProcessorTime, IdleThreadsAndStarvedOnesAreCountedApart) {
    PassReport report;
    report.threads = 2;
    report.seconds.all = 100;
    report.stats.busy_seconds = 190;
    report.stats.trace_seconds = 12;
    report.seconds.busy = {{1, 190.0}};
    report.seconds.worker = {{1, 11.4}};
    count_idle(report);
    EXPECT_DOUBLE_EQ(report.seconds.idle, 10);
    EXPECT_DOUBLE_EQ(*report.seconds.processor_share(1), 0.06);
    EXPECT_FALSE(report.seconds.processor_share(2));
}

}  // namespace
}  // namespace treefarm
