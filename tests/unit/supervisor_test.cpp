// SPDX-License-Identifier: Apache-2.0
// treefarm launch without a process: what it does about every sign, on a clock of its own.
#include "coordinator/launch/supervisor.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace treefarm {
namespace {

/// A world of one attempt at a time, and what the supervisor did to it.
class World {
  public:
    explicit World(SupervisorLimits limits = {})
        : supervisor_(limits,
                      {[this](int number) { begin(number); }, [this] { note("stop"); },
                       [this](const LifeStatus& status) { note("dump " + std::to_string(status.pid)); },
                       [this] { note("terminate"); }, [this] { note("kill"); },
                       [this](const std::string& words) { said.push_back(words); }},
                      [](int number) { return "run." + std::to_string(number); }) {}

    /// One step of the clock, in which the coordinator may do something.
    void step(double seconds = 1.0) {
        now += seconds;
        if (!end) end = supervisor_.step({now, running, readable, coordinator_gone, status, summary, checkpoint});
    }
    /// So many seconds, in each of which `life` happens.
    void pass(
        double seconds, const std::function<void()>& life = [] {}) {
        for (double t = 0; t < seconds && !end; ++t) {
            life();
            step();
        }
    }
    void live() {
        if (status) ++status->beat;
    }
    void work() {
        live();
        if (status) ++status->progress;
    }
    /// The coordinator is heard of for the first time.
    void appear(LifePhase phase = LifePhase::pass, std::uint32_t pass = 2) {
        status = LifeStatus{};
        status->attempt = "run." + std::to_string(attempt);
        status->phase = phase;
        status->pass = pass;
        status->host = "node1";
        status->pid = 42;
    }
    void die() { running = false; }
    /// The coordinator says its exit code, and all its processes leave.
    void finish(int code) {
        if (!status) appear();
        status->code = code;
        running = false;
    }
    /// A start, that comes to a pass.
    void run_to_pass(std::uint32_t pass = 2) {
        while (!running && !end)
            step();
        appear(LifePhase::pass, pass);
        step();
    }
    bool did(const std::string& deed) const { return std::find(deeds.begin(), deeds.end(), deed) != deeds.end(); }
    std::string last_said() const { return said.empty() ? "" : said.back(); }
    void stop() { supervisor_.ask_to_stop(); }

    double now = 0;
    bool running = false, readable = true, coordinator_gone = false;
    int attempt = 0;
    std::optional<LifeStatus> status;
    std::optional<int> summary;
    std::uint64_t checkpoint = 0;
    std::vector<std::string> deeds, said;
    std::vector<double> starts;
    std::optional<SupervisorEnd> end;

  private:
    void begin(int number) {
        attempt = number;
        running = true;
        summary.reset();
        starts.push_back(now);
        note("start");
    }
    void note(const std::string& deed) { deeds.push_back(deed); }

    Supervisor supervisor_;
};

TEST(Supervisor, ACalmRenderHasItsOwnExitCode) {
    for (const int code : {0, 2, 3, 4, 5}) {
        World world;
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
    World world;
    world.run_to_pass();
    world.summary = 4;
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 4);
}

TEST(Supervisor, OneThatNeverSpeaksIsKilledAndStartedAgain) {
    World world;
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
    World world;
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
    World world;
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
    World world;
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
    World world;
    world.run_to_pass();
    world.status->code = 4;
    world.coordinator_gone = true;
    world.pass(10);
    EXPECT_FALSE(world.did("terminate")) << "its launcher may end in order";
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 4);
}

TEST(Supervisor, OneThatBeatsWithoutProgressIsKilledLater) {
    World world;
    world.run_to_pass();
    world.pass(300, [&] { world.live(); });
    EXPECT_FALSE(world.did("terminate"));
    world.pass(3, [&] { world.live(); });
    EXPECT_TRUE(world.did("dump 42"));
    EXPECT_TRUE(world.did("terminate"));
}

TEST(Supervisor, APhaseThatTookLongBeforeMayTakeLongAgain) {
    World world;
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
    World world;
    world.run_to_pass();
    world.status->code = 0;
    world.status->phase = LifePhase::end;
    world.pass(15);
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2);
    EXPECT_TRUE(world.did("terminate"));
    world.pass(3);
    EXPECT_TRUE(world.did("kill"));
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 0);
    EXPECT_EQ(world.attempt, 1);
}

TEST(Supervisor, ACoordinatorThatStillBeatsAfterItsEndMayFinish) {
    World world;
    world.run_to_pass();
    world.status->code = 0;
    world.pass(590, [&] { world.live(); });
    EXPECT_FALSE(world.did("terminate")) << "a study writes its report";
    world.pass(15, [&] { world.live(); });
    EXPECT_TRUE(world.did("terminate"));
}

TEST(Supervisor, OneThatIsGoneWithoutAResultIsStartedAtOnce) {
    World world;
    world.run_to_pass();
    world.die();
    world.pass(3);
    EXPECT_EQ(world.attempt, 2);
    EXPECT_EQ(world.last_said(), "the render's processes are gone in pass 2 on node1; again in 1 s");
}

TEST(Supervisor, AFailedRenderIsTriedAgain) {
    World world;
    world.run_to_pass();
    world.finish(1);
    world.pass(3);
    EXPECT_FALSE(world.end);
    EXPECT_EQ(world.attempt, 2);
}

TEST(Supervisor, WhoCannotLookDoesNotKill) {
    World world;
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
    World world;
    world.run_to_pass();
    world.step(4000);
    world.pass(29);
    EXPECT_FALSE(world.did("terminate"));
}

TEST(Supervisor, PausesGrowAndDeathsAtOnePlaceEndItAndNameIt) {
    World world;
    while (!world.end) {
        world.run_to_pass(7);
        world.die();
        world.step();
    }
    EXPECT_EQ(world.attempt, 6);
    EXPECT_EQ(world.end->code, 1);
    EXPECT_TRUE(world.end->resumable);
    EXPECT_EQ(world.end->words,
              "the render's processes are gone in pass 7 on node1; given up after 6 attempts in a row that brought "
              "nothing, all of which ended there");
    const std::vector<double>& at = world.starts;
    EXPECT_LT(at[1] - at[0], at[3] - at[2]);
    EXPECT_GE(at[5] - at[4], 16);
}

TEST(Supervisor, DeathsAtSeveralPlacesNameTheLast) {
    World world({.restarts = 1});
    world.run_to_pass(3);
    world.die();
    world.run_to_pass(4);
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->words,
              "the render's processes are gone in pass 4 on node1; given up after 2 attempts in a row that brought "
              "nothing");
}

TEST(Supervisor, ProgressBeginsTheCountAnew) {
    const auto deaths = [](const std::function<void(World&)>& progress) {
        World world({.restarts = 2, .attempts = 20});
        while (!world.end) {
            world.run_to_pass();
            progress(world);
            world.step();
            world.die();
            world.step();
        }
        return world.attempt;
    };
    EXPECT_EQ(deaths([](World&) {}), 3);
    EXPECT_EQ(deaths([](World& world) { ++world.checkpoint; }), 21) << "to the limit of all";
    EXPECT_EQ(deaths([](World& world) { world.status->passes = static_cast<std::uint64_t>(world.attempt); }), 21);
    EXPECT_EQ(deaths([](World& world) { world.status->renders = 1; }), 21);
    EXPECT_EQ(deaths([](World& world) { world.checkpoint = 5; }), 3) << "the same checkpoint is no progress";
    EXPECT_EQ(deaths([](World& world) { world.checkpoint = world.attempt == 3 ? 1 : 0; }), 5);
}

TEST(Supervisor, WithoutRestartsTheFirstDeathEndsIt) {
    World world({.restarts = 0});
    world.run_to_pass();
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 1);
    EXPECT_NE(world.end->words.find("no restarts are left"), std::string::npos);
}

TEST(Supervisor, AStopWaitsForWhatIsWritten) {
    World world;
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

TEST(Supervisor, AStopThatIsNotHeardEndsByForce) {
    World world;
    world.run_to_pass();
    world.stop();
    world.pass(31, [&] { world.work(); });
    EXPECT_FALSE(world.did("terminate"));
    world.pass(2, [&] { world.work(); });
    EXPECT_TRUE(world.did("terminate")) << "it goes on rendering";
    world.pass(3);
    EXPECT_TRUE(world.did("kill"));
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 3);
    EXPECT_EQ(world.attempt, 1) << "a person's wish is no reason to start again";
}

TEST(Supervisor, ASecondStopGivesUpWhatIsNotWritten) {
    World world;
    world.run_to_pass();
    world.stop();
    world.step();
    EXPECT_FALSE(world.did("terminate"));
    world.stop();
    world.step();
    EXPECT_TRUE(world.did("terminate"));
    world.pass(4);
    EXPECT_TRUE(world.did("kill"));
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 3);
}

TEST(Supervisor, AStopBeforeTheFirstSignOfLifeIsNoSignalThatNobodyKnows) {
    World world;
    world.step();
    world.stop();
    world.step();
    EXPECT_FALSE(world.did("stop"));
    EXPECT_TRUE(world.did("terminate"));
    world.die();
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 3);
}

TEST(Supervisor, AStopBetweenTwoAttemptsStartsNone) {
    World world;
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
    World world;
    world.run_to_pass();
    world.pass(31);
    world.step();
    ASSERT_TRUE(world.did("terminate"));
    world.status->phase = LifePhase::end;
    world.finish(3);  // it takes our SIGTERM for a person's
    world.pass(3);
    EXPECT_FALSE(world.end);
    EXPECT_EQ(world.attempt, 2);
    EXPECT_EQ(world.last_said(), "no sign of life for 31 s in pass 2 on node1; again in 1 s");
}

TEST(Supervisor, ARenderThatWasDoneBeforeItsSilenceIsDone) {
    World world;
    world.run_to_pass();
    world.pass(32);
    ASSERT_TRUE(world.did("terminate"));
    world.finish(0);
    world.step();
    ASSERT_TRUE(world.end);
    EXPECT_EQ(world.end->code, 0);
}

TEST(LifeStatus, ComesBackFromItsFile) {
    LifeStatus status{"ab.3", 5, 6, LifePhase::combine, 7, 8, 9, "node1", 10, {{"node2", false}, {"node3", true}}, 4};
    const auto read = parse_life_status(life_status_text(status));
    ASSERT_TRUE(read);
    EXPECT_EQ(life_status_text(*read), life_status_text(status));
    EXPECT_EQ(read->workers, status.workers);
    EXPECT_EQ(read->code, 4);
    status.code.reset();
    EXPECT_FALSE(parse_life_status(life_status_text(status))->code);
}

TEST(LifeStatus, WhatIsNoneIsNone) {
    const std::string whole = life_status_text({});
    for (std::size_t k = 0; k + 2 < whole.size(); ++k)
        EXPECT_FALSE(parse_life_status(whole.substr(0, k))) << k;
    EXPECT_FALSE(parse_life_status("[]"));
    EXPECT_FALSE(parse_life_status("{\"attempt\": 3}"));
}

}  // namespace
}  // namespace treefarm
