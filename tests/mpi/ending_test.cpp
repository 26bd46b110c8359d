// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/mpi/program.h"
#include "tests/support/support.h"

// How runs end: with bad input, by signals, and when workers die.

namespace treefarm::test {
namespace {

std::vector<std::string> render_to_end(const std::string& scene, const std::filesystem::path& folder,
                                       const std::vector<std::string>& options = {}) {
    return std::vector<std::string>{TREEFARM_PROGRAM, "render", scene, "--run-dir", folder.string()} + options;
}

std::vector<std::string> long_render(const std::filesystem::path& folder, const std::string& spp) {
    return render_to_end(own_scene("cornell-box.xml"), folder,
                         {"-D", "size=64", "--spp", spp, "--threads", "1", "--set", "farm.heartbeat_seconds=0.2",
                          "--set", "farm.update_seconds=0.05", "--set", "farm.tile_size=16"});
}

std::filesystem::path bad_scene() {
    const auto path = fresh_folder("scene") / "bad.xml";
    std::ofstream(path) << "<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>\n";
    return path;
}

TEST(Ending, BadInputEndsWithCode2AndOneLine) {
    const auto scene = bad_scene();
    for (const int ranks : {0, 2, 4}) {
        const auto launcher = ranks == 0 ? std::vector<std::string>() : mpirun(ranks);
        const Ending ending = Program(launcher + render_to_end(scene, fresh_folder("run"))).wait(kSoon);
        EXPECT_FALSE(ending.timed_out) << ending.output;
        EXPECT_EQ(ending.code, 2) << ranks << " ranks: " << ending.output;
        EXPECT_EQ(count(ending.output, "treefarm: "), 1u) << ending.output;
        EXPECT_NE(ending.output.find("bad.xml:"), std::string::npos) << ending.output;
    }
}

TEST(Ending, BadUsageEndsWithCode2AndOneLine) {
    const std::vector<std::vector<std::string>> wrong = {{"render"},
                                                         {"render", ""},
                                                         {"render", "x.xml", "--no-such-option"},
                                                         {"render", "x.xml", "--seconds", "soon"},
                                                         {"render", "x.xml", "--error", "-1"},
                                                         {"render", "x.xml", "--spp", "4", "--seconds", "5"},
                                                         {"no-such-command"}};
    for (const auto& arguments : wrong)
        for (const int ranks : {0, 3}) {
            const auto launcher = ranks == 0 ? std::vector<std::string>() : mpirun(ranks);
            const Ending ending =
                Program(launcher + std::vector<std::string>{TREEFARM_PROGRAM} + arguments).wait(kSoon);
            EXPECT_FALSE(ending.timed_out) << ending.output;
            EXPECT_EQ(ending.code, 2) << ending.output;
            EXPECT_EQ(count(ending.output, "treefarm: "), 1u) << ending.output;
        }
}

TEST(Ending, ASignalKeepsFinishedPasses) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
        const auto folder = fresh_folder("run");
        Program program(long_render(folder, "1000000"));
        ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 2; }, kSoon));
        program.signal(number);
        const Ending ending = program.wait(kSoon);
        EXPECT_EQ(ending.code, 3) << ending.output;
        EXPECT_EQ(read_summary(folder)["state"], "interrupted");
        EXPECT_TRUE(std::filesystem::exists(folder / "image.exr"));
    }
}

TEST(Ending, ALimitOfFileSizesIsLikeAFullDisk) {
    const auto folder = fresh_folder("run"), output = fresh_folder("out") / "small.png";
    std::string command = "ulimit -f 20; exec";  // KiB: image and films are larger, the picture is not
    for (const std::string& word :
         render_to_end(own_scene("cornell-box.xml"), folder,
                       {"-D", "size=64", "--spp", "31", "--threads", "1", "-o", output.string()}))
        command += " '" + word + "'";
    const Ending ending = Program({"/bin/bash", "-c", command}).wait(kSoon);
    EXPECT_EQ(ending.code, 1) << ending.output;
    EXPECT_NE(ending.output.find("image.exr: cannot write (File too large)"), std::string::npos) << ending.output;
    EXPECT_EQ(read_summary(folder)["state"], "failed");
    EXPECT_TRUE(std::filesystem::exists(output));
}

TEST(Ending, ASignalToMpirunEndsEverything) {
    const auto folder = fresh_folder("run");
    Program program(mpirun(3) + long_render(folder, "1000000"));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 2; }, kSoon));
    program.signal(SIGTERM);
    const Ending ending = program.wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    EXPECT_EQ(read_summary(folder)["state"], "interrupted");
    EXPECT_TRUE(std::filesystem::exists(folder / "image.exr"));
}

TEST(Ending, AKilledWorkerCostsTimeNotBits) {
#ifdef NDEBUG
    const std::string spp = "1016";  // long enough to notice the loss
#else
    const std::string spp = "508";
#endif
    const auto calm = fresh_folder("calm");
    ASSERT_EQ(Program(long_render(calm, spp)).wait(kSoon).code, 0);
    const nlohmann::json truth = read_summary(calm);

    const auto folder = fresh_folder("run");
    Program program(mpirun(4, {"--enable-recovery"}) + long_render(folder, spp));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    const pid_t worker = program.rank(2);
    ASSERT_GT(worker, 0);
    ASSERT_EQ(kill(worker, SIGKILL), 0);
    const Ending ending = program.wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    const nlohmann::json summary = read_summary(folder);
    EXPECT_EQ(summary["state"], "done") << ending.output;
    EXPECT_EQ(summary["image_hash"], truth["image_hash"]);
    EXPECT_EQ(summary["tree_hash"], truth["tree_hash"]);
    EXPECT_EQ(summary["farm"]["workers"][1]["state"], "lost") << summary["farm"].dump(2);
}

TEST(Ending, WhenAllWorkersAreKilledTheRunFails) {
    const auto folder = fresh_folder("run");
    Program program(mpirun(3, {"--enable-recovery"}) + long_render(folder, "1000000"));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    for (const int rank : {1, 2})
        kill(program.rank(rank), SIGKILL);
    const Ending ending = program.wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    const nlohmann::json summary = read_summary(folder);
    EXPECT_EQ(summary["state"], "failed");
    EXPECT_NE(summary["error"].get<std::string>().find("no worker is left"), std::string::npos);
    EXPECT_GE(summary["spp"], 1) << "finished passes are kept";
    EXPECT_TRUE(std::filesystem::exists(folder / "image.exr"));
}

TEST(Ending, AFolderOfOtherFilesIsNoRunDirectory) {
    const auto folder = fresh_folder("mine");
    std::ofstream(folder / "job.toml") << "mine";
    const Ending ending = Program(long_render(folder, "4")).wait(kSoon);
    EXPECT_EQ(ending.code, 2) << ending.output;
    std::string text;
    std::ifstream(folder / "job.toml") >> text;
    EXPECT_EQ(text, "mine");
}

TEST(Ending, ADebugSampleTellsItsPath) {
    const auto folder = fresh_folder("run");
    const Ending ending =
        Program(std::vector<std::string>{TREEFARM_PROGRAM, "render", own_scene("cornell-box.xml"), "-D", "size=32",
                                         "--spp", "28", "--debug-sample", "3,16,16,3"})
            .wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("pass 3 pixel (16, 16) sample 3"), std::string::npos) << ending.output;
    const Ending wrong = Program(std::vector<std::string>{TREEFARM_PROGRAM, "render", own_scene("cornell-box.xml"),
                                                          "-D", "size=32", "--debug-sample", "1,32,0,0"})
                             .wait(kSoon);
    EXPECT_EQ(wrong.code, 2) << wrong.output;
}

/// A lamp in water: few samples carry much of the noise. The command that shows the worst of them is pasted.
TEST(Ending, AFireflyIsNamedAndCanBeSeen) {
    const auto folder = fresh_folder("run");
    const Ending ending =
        Program(std::vector<std::string>{TREEFARM_PROGRAM, "render", own_scene("water.xml"), "-D", "width=72", "-D",
                                         "height=64", "--spp", "63", "--run-dir", folder.string()})
            .wait(kSoon);
    ASSERT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("fireflies: 40 % of the noise is in "), std::string::npos) << ending.output;
    EXPECT_EQ(ending.output.find("--debug-sample"), std::string::npos) << "the command is in log.txt alone";
    std::ifstream file(folder / "log.txt");
    const std::string log(std::istreambuf_iterator<char>(file), {}), mark = ", vertex by vertex: ";
    const std::size_t at = log.find(mark);
    ASSERT_NE(at, std::string::npos) << log;
    const std::size_t begin = at + mark.size();
    const Ending seen =
        Program(std::vector<std::string>{"sh", "-c", log.substr(begin, log.find('\n', at) - begin)}).wait(kSoon);
    EXPECT_EQ(seen.code, 0) << seen.output;
    const nlohmann::json worst = nlohmann::json::parse(std::ifstream(folder / "summary.json"))["tail_worst"][0];
    std::ostringstream location;
    location << "pass " << worst["pass"] << " pixel (" << worst["x"] << ", " << worst["y"] << ") sample "
             << worst["sample"];
    EXPECT_TRUE(seen.output.starts_with(location.str())) << location.str() << "\n" << seen.output;
    EXPECT_NE(ending.output.find(worst["origin"].get<std::string>()), std::string::npos);
}

/// What the farm names that workers were lost over can be traced alone.
TEST(Ending, ADebugTileIsTracedAlone) {
    const auto traced = [](const char* tile) {
        return Program(std::vector<std::string>{TREEFARM_PROGRAM, "render", own_scene("cornell-box.xml"), "-D",
                                                "size=32", "--spp", "28", "--debug-sample", tile})
            .wait(kSoon);
    };
    const Ending ending = traced("3,8,8,24,16,0");
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("pass 3 pixels (8, 8) to below (24, 16): 512 paths"), std::string::npos)
        << ending.output;
    for (const char* wrong :
         {"3,8,8,8,16,0", "3,8,8,33,16,0", "9,8,8,24,16,0", "3,8,8,24,16,7", "3,8,8,24,16,x", "0,8,8,24,16,0"})
        EXPECT_EQ(traced(wrong).code, 2) << wrong;
}

/// mpirun would wait for a stopped worker for ever, with the image on disk.
TEST(Ending, AWorkerThatStandsStillForEverDoesNotHoldTheJob) {
    const auto folder = fresh_folder("run");
    Program program(mpirun(3, {"--enable-recovery"}) + long_render(folder, "60"));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    kill(program.rank(2), SIGSTOP);
    const Ending ending = program.wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    EXPECT_NE(ending.output.find("mpirun goes on waiting"), std::string::npos) << ending.output;
    EXPECT_EQ(read_summary(folder)["state"], "done");
}

}  // namespace
}  // namespace treefarm::test
