// SPDX-License-Identifier: Apache-2.0
// treefarm launch without a process: what it does about every sign of life, on a clock of its own.
#include "coordinator/launch/supervisor.h"

#include <gtest/gtest.h>

#include "tests/support/launch_world.h"

namespace treefarm {
namespace {

using test::LaunchWorld;

TEST(Supervisor, ACalmRenderHasItsOwnExitCode) {
    for (const int code : {0, 2, 3, 4, 5}) {
        LaunchWorld world;
        world.run_to_pass();
        world.pass(1000, [&] { world.work(); });
        world.finish(code);
        world.step();
        ASSERT_TRUE(world.end);
        EXPECT_EQ(world.end->code, code);
        EXPECT_EQ(world.deeds, std::vector<std::string>{"start"});
        EXPECT_TRUE(world.end->words.empty());
        EXPECT_EQ(world.end->resumable, code == 3);
    }
}

TEST(Supervisor, ASummaryIsEnough) {
    LaunchWorld world;
    world.run_to_pass();
    world.summary = 4;
    ASSERT_EQ(world.code_after_death(), 4);
}

TEST(Supervisor, OneThatNeverSpeaksIsKilledAndStartedAgain) {
    LaunchWorld world;
    world.step();
    world.pass(60);
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2);
    EXPECT_TRUE(world.did("terminate"));
    EXPECT_FALSE(world.did("kill"));
    world.pass(3);
    EXPECT_TRUE(world.did("kill"));
    EXPECT_EQ(world.attempt, 1) << "as long as it is there";
    world.die();
    world.pass(3);
    EXPECT_EQ(world.attempt, 2);
}

TEST(Supervisor, AnotherAttemptsSignIsNone) {
    LaunchWorld world;
    world.step();
    world.appear();
    world.status->attempt = "other.1";
    world.status->code = 0;
    world.pass(60, [&] { world.work(); });
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2, [&] { world.work(); });
    EXPECT_TRUE(world.did("terminate"));
    EXPECT_FALSE(world.end);
}

TEST(Supervisor, OneThatDoesNotBeatIsKilled) {
    LaunchWorld world;
    world.run_to_pass();
    world.pass(100, [&] { world.work(); });
    world.pass(30);
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2);
    EXPECT_TRUE(world.did("terminate"));
    EXPECT_FALSE(world.did("dump 42")) << "it would not come to writing a core";
    EXPECT_EQ(world.last_said(), "no sign of life for 31 s");
}

TEST(Supervisor, ACoordinatorThatIsSeenToBeGoneIsNotWaitedFor) {
    LaunchWorld world;
    world.run_to_pass();
    world.coordinator_gone = true;
    world.step();
    EXPECT_TRUE(world.did("terminate"));
    world.die();
    world.coordinator_gone = false;
    world.pass(3);
    EXPECT_EQ(world.attempt, 2);
}

TEST(Supervisor, ACoordinatorThatIsGoneWithAResultHasEnded) {
    LaunchWorld world;
    world.run_to_pass();
    world.status->code = 4;
    world.coordinator_gone = true;
    world.pass(10);
    EXPECT_FALSE(world.did("terminate")) << "its launcher may end in order";
    ASSERT_EQ(world.code_after_death(), 4);
}

TEST(Supervisor, OneThatBeatsWithoutProgressIsKilledLater) {
    LaunchWorld world;
    world.run_to_pass();
    world.pass(300, [&] { world.live(); });
    EXPECT_FALSE(world.did("terminate"));
    world.pass(3, [&] { world.live(); });
    EXPECT_TRUE(world.did("dump 42"));
    EXPECT_TRUE(world.did("terminate"));
}

TEST(Supervisor, APhaseThatTookLongBeforeMayTakeLongAgain) {
    LaunchWorld world;
    world.run_to_pass();
    world.pass(200, [&] { world.live(); });
    world.work();
    world.step();
    world.pass(990, [&] { world.live(); });
    EXPECT_FALSE(world.did("terminate"));
    world.status->phase = LifePhase::gather;
    world.step();
    world.pass(305, [&] { world.live(); });
    EXPECT_TRUE(world.did("terminate")) << "another phase has its own limit";
}

TEST(Supervisor, ALauncherThatOutlivesTheResultIsEndedAndTheResultStands) {
    LaunchWorld world;
    world.run_to_pass();
    world.status->code = 0;
    world.status->phase = LifePhase::end;
    world.pass(15);
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2);
    EXPECT_TRUE(world.did("terminate"));
    world.pass(3);
    EXPECT_TRUE(world.did("kill"));
    ASSERT_EQ(world.code_after_death(), 0);
    EXPECT_EQ(world.attempt, 1);
}

TEST(Supervisor, ACoordinatorThatStillBeatsAfterItsEndMayFinish) {
    LaunchWorld world;
    world.run_to_pass();
    world.status->code = 0;
    world.pass(590, [&] { world.live(); });
    EXPECT_FALSE(world.did("terminate")) << "a study writes its report";
    world.pass(15, [&] { world.live(); });
    EXPECT_TRUE(world.did("terminate"));
}

TEST(Supervisor, OneThatIsGoneWithoutAResultIsStartedAtOnce) {
    LaunchWorld world;
    world.run_to_pass();
    world.die();
    world.pass(3);
    EXPECT_EQ(world.attempt, 2);
    EXPECT_EQ(world.last_said(), "the render's processes are gone in pass 3 on node1; again in 1 s");
}

TEST(Supervisor, AFailedRenderIsTriedAgain) {
    LaunchWorld world;
    world.run_to_pass();
    world.finish(1);
    world.pass(3);
    EXPECT_FALSE(world.end);
    EXPECT_EQ(world.attempt, 2);
}

TEST(Supervisor, WhoCannotLookDoesNotKill) {
    LaunchWorld world;
    world.run_to_pass();
    world.readable = false;
    world.pass(1000);
    EXPECT_FALSE(world.did("terminate"));
    EXPECT_EQ(world.said.size(), 1u) << "and says so once";
    world.readable = true;
    world.pass(32);
    EXPECT_TRUE(world.did("terminate"));
}

TEST(Supervisor, ASupervisorThatSleptForgivesTheSilence) {
    LaunchWorld world;
    world.run_to_pass();
    world.step(4000);
    world.pass(29);
    EXPECT_FALSE(world.did("terminate"));
}

}  // namespace
}  // namespace treefarm
