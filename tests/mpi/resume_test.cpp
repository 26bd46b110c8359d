// SPDX-License-Identifier: Apache-2.0
// treefarm resume: whatever broke a render off, and wherever it goes on, its bits are those of one that never stopped.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "tests/mpi/program.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {
namespace {

const std::vector<std::string> kFast = {
    "--threads", "1", "--set", "farm.checkpoint_seconds=0.001", "--set", "farm.heartbeat_seconds=0.2"};

std::vector<std::string> render_to_resume(const fs::path& folder,
                                          const std::vector<std::string>& options = {"--spp", "255"}) {
    return std::vector<std::string>{TREEFARM_PROGRAM, "render",       own_scene("cornell-box.xml"), "-D", "size=48",
                                    "--run-dir",      folder.string()} +
           kFast + options;
}

std::vector<std::string> resume(const fs::path& folder, const std::vector<std::string>& options = {}) {
    return std::vector<std::string>{TREEFARM_PROGRAM, "resume", folder.string()} + options;
}

std::vector<std::string> launcher(int ranks) {
    return ranks > 1 ? mpirun(ranks) : std::vector<std::string>();
}

const RunHashes& never_stopped() {
    static const RunHashes truth = [] {
        const fs::path folder = fresh_folder("whole");
        const Ending ending = Program(render_to_resume(folder)).wait(kSoon);
        EXPECT_EQ(ending.code, 0) << ending.output;
        return hashes_of(folder);
    }();
    return truth;
}

/// Starts a render on so many ranks, and kills all of it with SIGKILL once it has a checkpoint and some time has
/// passed.
void kill_after(const std::vector<std::string>& command, int ranks, const fs::path& folder, double seconds) {
    Program program(launcher(ranks) + command);
    EXPECT_TRUE(program.wait_until([&] { return has_checkpoint(folder); }, kSoon));
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    if (ranks > 1)
        for (int rank = 0; rank < ranks; ++rank)
            if (const pid_t pid = program.rank(rank); pid > 0) kill(pid, SIGKILL);
    program.signal(SIGKILL);
    program.wait(kSoon);
}

int resumed(int ranks, const fs::path& folder, const std::vector<std::string>& options = {}) {
    const Ending ending = Program(launcher(ranks) + resume(folder, options)).wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    if (ending.code != 0) std::cout << ending.output;
    return ending.code;
}

/// The message of a resume that is refused; the folder is as it was.
std::string refusal(const fs::path& folder, const std::vector<std::string>& options = {}) {
    const auto before = fs::last_write_time(folder / "job.toml");
    const Ending ending = Program(resume(folder, options)).wait(kSoon);
    EXPECT_EQ(ending.code, 2) << ending.output;
    EXPECT_EQ(fs::last_write_time(folder / "job.toml"), before);
    return ending.output;
}

/// A render that was broken off.
fs::path broken_off(const std::vector<std::string>& options = {"--spp", "255"}) {
    const fs::path folder = fresh_folder("run");
    kill_after(render_to_resume(folder, options), 1, folder, 0.0);
    return folder;
}

TEST(Resume, AKilledProgramGoesOnUnderAnyNumberOfRanks) {
    std::mt19937 random(1);
    int k = 0, resumes = 0;
    for (const auto& [before, after] : {std::pair(1, 3), std::pair(3, 1), std::pair(2, 5), std::pair(1, 1)}) {
        const fs::path folder = fresh_folder("run");
        kill_after(render_to_resume(folder), before, folder, 0.05 * static_cast<double>(random() % 8));
        if (fs::exists(folder / "summary.json")) continue;  // it was done before
        ++resumes;
        EXPECT_EQ(resumed(after, folder, {"--threads", std::to_string(1 + k++ % 3)}), 0);
        EXPECT_EQ(hashes_of(folder), never_stopped()) << before << " ranks, then " << after;
        EXPECT_EQ(passes_done(folder), 8) << "passes.csv has no hole";
    }
    EXPECT_GT(resumes, 0) << "none was killed in time";
}

const std::vector<std::string> kOnePass = {"--spp", "1500", "--set", "guiding.spp_unit=1500"};

const RunHashes& one_pass() {
    static const RunHashes truth = [] {
        const fs::path folder = fresh_folder("one-pass");
        EXPECT_EQ(Program(render_to_resume(folder, kOnePass)).wait(kSoon).code, 0);
        return hashes_of(folder);
    }();
    return truth;
}

/// Whether one of the checkpoints is of a pass in hand.
bool has_partial_pass(const fs::path& folder) {
    for (const char* name : {"a.tfc", "b.tfc"}) {
        std::ifstream file(folder / "checkpoint" / name, std::ios::binary);
        if ((std::stringstream() << file.rdbuf()).str().find("OPEN") != std::string::npos) return true;
    }
    return false;
}

TEST(Resume, AProgramThatIsKilledWithinAPassGoesOnWithinIt) {
    const RunHashes& truth = one_pass();
    const fs::path folder = fresh_folder("run");
    Program program(render_to_resume(folder, kOnePass));
    ASSERT_TRUE(program.wait_until([&] { return has_partial_pass(folder); }, kSoon));
    program.signal(SIGKILL);
    program.wait(kSoon);
    ASSERT_FALSE(fs::exists(folder / "summary.json"));
    const Ending ending = Program(mpirun(3) + resume(folder, {"--set", "farm.tile_size=9"})).wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("0 passes with 0 spp are done, one is partly done"), std::string::npos)
        << ending.output;
    EXPECT_EQ(hashes_of(folder), truth);
}

TEST(Resume, AProgramThatIsInterruptedWithinItsFirstPassKeepsWhatItHas) {
    const RunHashes& truth = one_pass();
    const fs::path folder = fresh_folder("run");
    Program program(render_to_resume(folder, kOnePass));
    ASSERT_TRUE(program.wait_until([&] { return has_partial_pass(folder); }, kSoon));
    program.signal(SIGINT);
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 3) << ending.output;
    EXPECT_NE(ending.output.find("% of the unfinished pass; go on with: treefarm resume " + folder.string()),
              std::string::npos)
        << ending.output;
    EXPECT_FALSE(fs::exists(folder / "image.exr"));
    EXPECT_EQ(resumed(2, folder), 0);
    EXPECT_EQ(hashes_of(folder), truth);
}

/// A render that was killed, of passes whose films are sums of splats.
void expect_that_splats_go_on(const std::string& type, const char* spp) {
    const std::vector<std::string> options = {"--spp", spp, "--set", "integrator.type=" + type};
    const fs::path whole = fresh_folder("whole-" + type);
    EXPECT_EQ(Program(render_to_resume(whole, options)).wait(kSoon).code, 0);
    const fs::path folder = broken_off(options);
    ASSERT_FALSE(fs::exists(folder / "summary.json")) << "it was done before it could be killed";
    EXPECT_EQ(resumed(3, folder, {"--threads", "2"}), 0);
    EXPECT_EQ(hashes_of(folder), hashes_of(whole));
}

TEST(Resume, AKilledRenderOfLightPathsGoesOn) {
    expect_that_splats_go_on("light", "508");
}

TEST(Resume, AKilledRenderFromBothEndsGoesOn) {
    expect_that_splats_go_on("bidirectional", "124");
}

TEST(Resume, AnInterruptedProgramGoesOn) {
    const fs::path folder = fresh_folder("run");
    Program program(render_to_resume(folder));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 5; }, kSoon));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait(kSoon).code, 3);
    EXPECT_EQ(resumed(2, folder), 0);
    EXPECT_EQ(hashes_of(folder), never_stopped());
}

TEST(Resume, AGrownBudgetAndATimedOneAreWhatTheirScheduleReplays) {
    for (const auto& [first, more] :
         {std::pair<std::vector<std::string>, std::vector<std::string>>{{"--spp", "63"}, {"--spp", "200"}},
          {{"--seconds", "1"}, {"--seconds", "2"}},
          {{"--error", "40%"}, {"--error", "30%"}}}) {
        const fs::path folder = fresh_folder("run");
        ASSERT_EQ(Program(render_to_resume(folder, first)).wait(kSoon).code, 0);
        const int spp = read_summary(folder)["spp"];
        ASSERT_EQ(resumed(2, folder, more), 0);
        EXPECT_GT(read_summary(folder)["spp"], spp);
        const fs::path again = fresh_folder("again");
        const Ending replay = Program({TREEFARM_PROGRAM, "render", (folder / "job.toml").string(), "--schedule",
                                       (folder / "schedule.toml").string(), "--run-dir", again.string()})
                                  .wait(kSoon);
        ASSERT_EQ(replay.code, 0) << replay.output;
        EXPECT_EQ(hashes_of(again), hashes_of(folder)) << more[0];
    }
}

TEST(Resume, TheSecondsOfAllLivesCount) {
    const fs::path folder = fresh_folder("run");
    kill_after(render_to_resume(folder, {"--seconds", "4"}), 1, folder, 1.5);
    ASSERT_EQ(resumed(1, folder), 0);
    const nlohmann::json summary = read_summary(folder);
    EXPECT_GT(summary["passes"].back()["run_seconds"], summary["seconds"]) << "more than this life's";
}

TEST(Resume, WhereTheNewestIsDamagedTheOneBeforeIsUsed) {
    const fs::path folder = fresh_folder("run");
    Program program(render_to_resume(folder));
    ASSERT_TRUE(program.wait_until(
        [&] { return fs::exists(folder / "checkpoint/a.tfc") && fs::exists(folder / "checkpoint/b.tfc"); }, kSoon));
    program.signal(SIGKILL);
    program.wait(kSoon);
    const bool a_is_newer =
        fs::last_write_time(folder / "checkpoint/a.tfc") > fs::last_write_time(folder / "checkpoint/b.tfc");
    const fs::path newest = folder / (a_is_newer ? "checkpoint/a.tfc" : "checkpoint/b.tfc");
    fs::resize_file(newest, fs::file_size(newest) / 2);
    const Ending ending = Program(resume(folder)).wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find(newest.filename().string() + " is cut off at "), std::string::npos) << ending.output;
    EXPECT_EQ(hashes_of(folder), never_stopped());
}

TEST(Resume, OnlyItsOwnRenderGoesOn) {
    const fs::path folder = broken_off();
    const std::string refused = refusal(folder, {"--set", "guiding.type=none"});
    EXPECT_NE(refused.find("--set: would make another render: guiding.type was \"view\", is \"none\"; only farm.*"),
              std::string::npos)
        << refused;
    EXPECT_NE(
        refused.find("for the new job: treefarm render " + (folder / "job.toml").string() + " --set guiding.type=none"),
        std::string::npos)
        << refused;
    EXPECT_NE(refusal(folder, {"--set", "sampler.seed=3"}).find("sampler.seed was \"0\", is \"3\""), std::string::npos);
    EXPECT_NE(refusal(folder, {"--set", "farm.isa=sse2"}).find("farm.isa was"), std::string::npos);
    EXPECT_EQ(resumed(1, folder, {"--set", "farm.tile_size=7", "--set", "output.half=true"}), 0);
    EXPECT_EQ(hashes_of(folder), never_stopped());
    EXPECT_NE(refusal(folder).find("is done (255 spp); add samples with --spp N above that"), std::string::npos);
    EXPECT_NE(refusal(folder, {"--spp", "100"}).find("is done (255 spp)"), std::string::npos);
}

TEST(Resume, ASceneThatHasChangedIsRefused) {
    const fs::path scene = fresh_folder("scene") / "box.xml";
    fs::copy_file(own_scene("cornell-box.xml"), scene);
    const fs::path folder = fresh_folder("run");
    std::vector<std::string> command = render_to_resume(folder);
    command[2] = scene.string();
    kill_after(command, 1, folder, 0.0);
    std::string text = read_file(scene);
    const std::size_t at = text.find("reflectance\" value=\"0.");
    ASSERT_NE(at, std::string::npos);
    text.replace(text.find("0.", at), 3, "0.5");
    std::ofstream(scene) << text;
    EXPECT_NE(refusal(folder).find("the scene has changed since"), std::string::npos);
}

TEST(Resume, WhatIsNoRunDirectorySaysSo) {
    const fs::path folder = fresh_folder("run");
    const Ending ending = Program(resume(folder)).wait(kSoon);
    EXPECT_EQ(ending.code, 2);
    EXPECT_NE(ending.output.find("is no run directory"), std::string::npos) << ending.output;
    ASSERT_EQ(
        Program(render_to_resume(folder, {"--spp", "4", "--set", "output.keep_checkpoint=false"})).wait(kSoon).code, 0);
    EXPECT_FALSE(fs::exists(folder / "checkpoint"));
    EXPECT_NE(refusal(folder).find("holds no checkpoint"), std::string::npos);
}

TEST(Resume, TheImageGoesWhereTheRenderWouldHavePutIt) {
    const fs::path image = fresh_folder("out") / "box.exr";
    const fs::path folder = broken_off({"--spp", "255", "-o", image.string()});
    EXPECT_FALSE(fs::exists(image));
    EXPECT_EQ(resumed(1, folder), 0);
    EXPECT_TRUE(fs::exists(image));
}

/// As a queue does that tries again.
TEST(RenderResume, TheSameCommandBeginsGoesOnAndIsDone) {
    const fs::path folder = fresh_folder("run"), image = fresh_folder("out") / "box.exr";
    const std::vector<std::string> command =
        render_to_resume(folder, {"--spp", "255", "--resume", "-o", image.string()});
    kill_after(command, 1, folder, 0.0);
    const Ending ending = Program(mpirun(3) + command).wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("going on with"), std::string::npos) << ending.output;
    EXPECT_EQ(hashes_of(folder), never_stopped());
    const nlohmann::json before = read_summary(folder);
    fs::remove(image);
    for (const int ranks : {1, 3}) {
        const Ending again = Program(launcher(ranks) + command).wait(kSoon);
        EXPECT_EQ(again.code, 0) << again.output;
        EXPECT_NE(again.output.find("holds this render already: done, 255 spp"), std::string::npos) << again.output;
        EXPECT_EQ(read_summary(folder), before) << "rendered again: its seconds differ";
        EXPECT_TRUE(fs::exists(image));
    }
}

TEST(RenderResume, AnotherRenderIsNeitherGoneOnWithNorReplaced) {
    const fs::path folder = broken_off();
    const Ending other =
        Program(render_to_resume(folder, {"--spp", "255", "--resume", "--set", "sampler.seed=3"})).wait(kSoon);
    EXPECT_EQ(other.code, 2) << other.output;
    EXPECT_NE(other.output.find("sampler.seed was \"0\", is \"3\""), std::string::npos) << other.output;
    ASSERT_EQ(Program(render_to_resume(folder, {"--spp", "255", "--resume"})).wait(kSoon).code, 0);
    EXPECT_EQ(hashes_of(folder), never_stopped());
    const Ending more = Program(render_to_resume(folder, {"--spp", "600", "--resume"})).wait(kSoon);
    EXPECT_EQ(more.code, 0) << more.output;
    EXPECT_EQ(read_summary(folder)["spp"], 600);
    const Ending fewer = Program(render_to_resume(folder, {"--spp", "100", "--resume"})).wait(kSoon);
    EXPECT_EQ(fewer.code, 2) << fewer.output;
    EXPECT_NE(fewer.output.find("is done (600 spp)"), std::string::npos) << fewer.output;
    const Ending nowhere = Program({TREEFARM_PROGRAM, "render", own_scene("cornell-box.xml"), "--resume"}).wait(kSoon);
    EXPECT_EQ(nowhere.code, 2);
    EXPECT_NE(nowhere.output.find("name it with --run-dir"), std::string::npos) << nowhere.output;
}

}  // namespace
}  // namespace treefarm::test
