// SPDX-License-Identifier: Apache-2.0
// How treefarm launch ends, on a clock of its own: when it gives up, and when a person stops it.
#include <gtest/gtest.h>

#include "coordinator/launch/supervisor.h"
#include "tests/support/launch_world.h"

namespace treefarm {
namespace {

using test::LaunchWorld;

TEST(Supervisor, PausesGrowAndDeathsAtOneStageEndItAndNameIt) {
    LaunchWorld world;
    while (!world.end) {
        world.run_to_pass(7);
        world.die();
        world.step();
    }
    EXPECT_EQ(world.attempt, 6);
    EXPECT_EQ(world.end->code, 1);
    EXPECT_TRUE(world.end->resumable);
    EXPECT_EQ(world.end->words,
              "the render's processes are gone in pass 8 on node1; given up after 6 attempts in a row without "
              "progress, all of which ended there");
    const std::vector<double>& at = world.starts;
    EXPECT_LT(at[1] - at[0], at[3] - at[2]);
    EXPECT_GE(at[5] - at[4], 16);
}

TEST(Supervisor, DeathsAtSeveralStagesNameTheLast) {
    LaunchWorld world({.restarts = 1});
    world.run_to_pass(3);
    world.die();
    world.run_to_pass(4);
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->words,
              "the render's processes are gone in pass 5 on node1; given up after 2 attempts in a row without "
              "progress");
}

TEST(Supervisor, ProgressBeginsTheCountAnew) {
    const auto deaths = [](const std::function<void(LaunchWorld&)>& progress) {
        LaunchWorld world({.restarts = 2, .attempts = 20});
        while (!world.end) {
            world.run_to_pass();
            progress(world);
            world.step();
            world.die();
            world.step();
        }
        return world.attempt;
    };
    EXPECT_EQ(deaths([](LaunchWorld&) {}), 3);
    EXPECT_EQ(deaths([](LaunchWorld& world) { ++world.checkpoint; }), 21) << "to the limit of all";
    EXPECT_EQ(deaths([](LaunchWorld& world) { world.status->passes = static_cast<std::uint64_t>(world.attempt); }), 21);
    EXPECT_EQ(deaths([](LaunchWorld& world) { world.status->renders = 1; }), 21);
    EXPECT_EQ(deaths([](LaunchWorld& world) { world.checkpoint = 5; }), 3) << "the same checkpoint is no progress";
    EXPECT_EQ(deaths([](LaunchWorld& world) { world.checkpoint = world.attempt == 3 ? 1 : 0; }), 5);
}

TEST(Supervisor, WithoutRestartsTheFirstDeathEndsIt) {
    LaunchWorld world({.restarts = 0});
    world.run_to_pass();
    ASSERT_EQ(world.code_after_death(), 1);
    EXPECT_NE(world.end->words.find("no restarts are left"), std::string::npos);
}

/// Hosts that do not answer come back: their absence is an attempt as any other, and does not end the launch at once.
TEST(Supervisor, AnAttemptThatCannotBeStartedIsTriedAgain) {
    LaunchWorld world({.restarts = 2});
    world.run_to_pass();
    world.not_started = "hosts: no host answers";
    world.die();
    world.pass(3);
    EXPECT_EQ(world.attempt, 2);
    EXPECT_EQ(world.last_said(),
              "it could not be started (hosts: no host answers) in the start, before any sign of life; again in 2 s");
    world.not_started.clear();
    world.status.reset();
    world.pass(4);
    EXPECT_EQ(world.attempt, 3);
    EXPECT_TRUE(world.running);
    EXPECT_FALSE(world.end);
    world.not_started = "hosts: no host answers";
    world.die();
    world.pass(60);
    ASSERT_TRUE(world.end);
    EXPECT_TRUE(world.end->resumable);
    EXPECT_NE(world.end->words.find("it could not be started (hosts: no host answers)"), std::string::npos);
}

TEST(Supervisor, ADiskThatTakesNoFilesIsWaitedForAndCountsForNothing) {
    for (const int code : {0, 1, 2}) {  // 0: killed, without a word
        LaunchWorld world({.restarts = 1});
        const auto die_on_full_disk = [&] {
            world.run_to_pass();
            world.disk = "run: No space left on device";
            if (code > 0 && world.attempt > 1) world.finish(code);
            world.die();
            world.step();
        };
        for (int k = 1; k <= 9; ++k) {
            die_on_full_disk();
            EXPECT_EQ(world.last_said(),
                      std::string(code > 0 && k > 1 ? "the render failed" : "the render's processes are gone") +
                          " in pass 3 on node1; again when the disk takes files: " + world.disk);
            const std::size_t said = world.said.size();
            world.pass(4000);
            EXPECT_EQ(world.attempt, k) << "no attempt can succeed now";
            EXPECT_EQ(world.said.size(), said) << "it is said once";
            world.disk.clear();
            world.pass(2);
            EXPECT_EQ(world.attempt, k + 1);
        }
        EXPECT_FALSE(world.end);
        world.run_to_pass();
        world.finish(0);
        world.step();
        ASSERT_TRUE(world.end);
        EXPECT_EQ(world.end->code, 0);
    }
}

TEST(Supervisor, AnAttemptThatTheDiskDoesNotLetStartIsRepeatedWithoutCounting) {
    LaunchWorld world({.restarts = 0});
    world.run_to_pass();
    world.not_started = world.disk = "/tmp: no folder can be made in it (No space left on device)";
    world.die();
    world.step();
    for (int k = 2; k < 9; ++k) {
        world.disk.clear();  // only the start meets it
        while (world.attempt < k && !world.end)
            world.step();
        ASSERT_FALSE(world.end);
        world.disk = world.not_started;
        world.step();
    }
    EXPECT_EQ(world.said.size(), 1u) << "it is said once";
}

TEST(Supervisor, ADiskThatNobodyEmptiesIsGivenUp) {
    LaunchWorld world;
    world.run_to_pass();
    world.disk = "run: No space left on device";
    world.die();
    world.pass(12 * 3600);
    EXPECT_FALSE(world.end);
    world.pass(60);
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 1);
    EXPECT_TRUE(world.end->resumable);
    EXPECT_EQ(world.end->words, "the disk has taken no files for 12 h: run: No space left on device");
}

TEST(Supervisor, ADiskThatIsFullAtOnceIsAnError) {
    LaunchWorld world;
    world.disk = "run: No space left on device";
    world.run_to_pass();
    world.finish(2);
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 2);
}

TEST(Supervisor, AStopWaitsForWhatIsWritten) {
    LaunchWorld world;
    world.run_to_pass();
    world.stop();
    world.step();
    EXPECT_TRUE(world.did("stop"));
    world.status->phase = LifePhase::write;
    world.pass(500, [&] { world.work(); });
    EXPECT_FALSE(world.did("terminate"));
    world.finish(3);
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 3);
    EXPECT_TRUE(world.end->resumable);
}

TEST(Supervisor, AnEndThatOnlyTheLauncherWantedIsNone) {
    LaunchWorld world;
    world.run_to_pass();
    world.status->ended_by_launcher = true;  // mpirun, which has lost a host
    world.finish(3);
    world.step();
    EXPECT_FALSE(world.end);
    EXPECT_EQ(world.last_said(), "the launcher ended the render in pass 3 on node1; again in 1 s");
    world.run_to_pass();
    EXPECT_EQ(world.attempt, 2);
    world.stop();
    world.step();
    world.status->ended_by_launcher = true;
    world.finish(3);
    world.step();
    ASSERT_TRUE(world.end) << "a person wants it, too";
    EXPECT_EQ(world.end->code, 3);
}

TEST(Supervisor, AStopThatIsNotHeardEndsByForce) {
    LaunchWorld world;
    world.run_to_pass();
    world.stop();
    world.pass(31, [&] { world.work(); });
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2, [&] { world.work(); });
    EXPECT_TRUE(world.did("terminate")) << "it goes on rendering";
    world.pass(3);
    EXPECT_TRUE(world.did("kill"));
    ASSERT_EQ(world.code_after_death(), 3);
    EXPECT_EQ(world.attempt, 1) << "a person's wish is no reason to start again";
}

TEST(Supervisor, ASecondStopGivesUpWhatIsNotWritten) {
    LaunchWorld world;
    world.run_to_pass();
    world.stop();
    world.step();
    EXPECT_FALSE(world.did("terminate"));
    world.stop();
    world.step();
    EXPECT_TRUE(world.did("terminate"));
    world.pass(4);
    EXPECT_TRUE(world.did("kill"));
    ASSERT_EQ(world.code_after_death(), 3);
}

TEST(Supervisor, AStopBeforeTheFirstSignOfLifeIsNoSignalThatNobodyKnows) {
    LaunchWorld world;
    world.step();
    world.stop();
    world.step();
    EXPECT_FALSE(world.did("stop"));
    EXPECT_TRUE(world.did("terminate"));
    ASSERT_EQ(world.code_after_death(), 3);
}

TEST(Supervisor, AStopBetweenTwoAttemptsStartsNone) {
    LaunchWorld world;
    world.run_to_pass();
    world.die();
    world.step();
    world.stop();
    world.pass(5);
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 3);
    EXPECT_EQ(world.attempt, 1);
}

TEST(Supervisor, OneThatEndsInOrderWhenItIsEndedForItsSilenceGoesOn) {
    LaunchWorld world;
    world.run_to_pass();
    world.pass(31);
    world.step();
    ASSERT_TRUE(world.did("terminate"));
    world.status->phase = LifePhase::end;
    world.finish(3);  // it takes our SIGTERM for a person's
    world.pass(3);
    EXPECT_FALSE(world.end);
    EXPECT_EQ(world.attempt, 2);
    EXPECT_EQ(world.last_said(), "no sign of life for 31 s in pass 3 on node1; again in 1 s");
}

TEST(Supervisor, ARenderThatWasDoneBeforeItsSilenceIsDone) {
    LaunchWorld world;
    world.run_to_pass();
    world.pass(32);
    ASSERT_TRUE(world.did("terminate"));
    world.finish(0);
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 0);
}

}  // namespace
}  // namespace treefarm
