// SPDX-License-Identifier: Apache-2.0
// treefarm launch: whatever dies beneath it, the render ends with the bits of one that never stopped, and nothing
// stays.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>

#include "tests/mpi/program.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {
namespace {

std::vector<std::string> launch(int processes, const std::vector<std::string>& options = {}) {
    return std::vector<std::string>{TREEFARM_PROGRAM, "launch", "-n", std::to_string(processes)} + options +
           std::vector<std::string>{"--"};
}

std::vector<std::string> render_arguments(const fs::path& folder,
                                          const std::vector<std::string>& options = {"--spp", "255"}) {
    return std::vector<std::string>{"render",    own_scene("cornell-box.xml"),
                                    "-D",        "size=48",
                                    "--run-dir", folder.string(),
                                    "--threads", "1",
                                    "--set",     "farm.checkpoint_seconds=0.001",
                                    "--set",     "farm.heartbeat_seconds=0.2"} +
           options;
}

std::vector<std::string> plain(const fs::path& folder, const std::vector<std::string>& options = {"--spp", "255"}) {
    return std::vector<std::string>{TREEFARM_PROGRAM} + render_arguments(folder, options);
}

/// A render that ends only when somebody ends it.
const std::vector<std::string> kEndless = {"--spp", "100000000"};

const RunHashes& plain_hashes() {
    static const RunHashes truth = [] {
        const fs::path folder = fresh_folder("whole");
        const Ending ending = Program(plain(folder)).wait(kSoon);
        EXPECT_EQ(ending.code, 0) << ending.output;
        return hashes_of(folder);
    }();
    return truth;
}

/// A process that an attempt of the launch of this folder has started.
struct Started {
    pid_t pid = 0;
    std::string command;  ///< words, each with a blank behind it
    int rank = -1;        ///< under mpirun
};

std::vector<Started> started(const fs::path& folder) {
    std::vector<Started> found;
    const std::string wanted = ":" + (folder / "launch" / "status.json").string();
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string variables = '\0' + read_file(entry.path() / "environ");
        const std::size_t at = variables.find(std::string(1, '\0') + "TREEFARM_ATTEMPT=");
        if (at == std::string::npos || variables.find(wanted + '\0', at) == std::string::npos) continue;
        Started process{std::stoi(name), read_file(entry.path() / "cmdline"), -1};
        for (char& c : process.command)
            if (c == '\0') c = ' ';
        const std::string rank = std::string(1, '\0') + "OMPI_COMM_WORLD_RANK=";
        if (const std::size_t number = variables.find(rank); number != std::string::npos)
            process.rank = std::atoi(variables.c_str() + number + rank.size());
        found.push_back(process);
    }
    return found;
}

/// Shared memory and folders for temporary files, as far as launches of ours may have made them.
std::set<fs::path> leftovers() {
    std::set<fs::path> found;
    for (const char* folder : {"/dev/shm", "/tmp"})
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().filename().string().starts_with("treefarm-launch-")) found.insert(entry.path());
    return found;
}

void expect_nothing_left(const fs::path& folder) {
    EXPECT_TRUE(started(folder).empty()) << started(folder).front().command;
    EXPECT_TRUE(leftovers().empty()) << *leftovers().begin();
}

/// Kills processes of the attempt with SIGKILL.
int kill_started(const fs::path& folder, const std::function<bool(const Started&)>& which) {
    int killed = 0;
    for (const Started& process : started(folder))
        if (which(process)) killed += kill(process.pid, SIGKILL) == 0;
    return killed;
}

bool is_mpirun(const Started& process) {
    return process.command.starts_with("mpirun ");
}

TEST(Launch, ACalmRenderIsThePlainOne) {
    for (const int processes : {1, 3}) {
        const fs::path folder = fresh_folder("run");
        const Ending ending = Program(launch(processes) + render_arguments(folder)).wait(kSoon);
        EXPECT_EQ(ending.code, 0) << ending.output;
        EXPECT_EQ(hashes_of(folder), plain_hashes());
        EXPECT_TRUE(read_summary(folder)["attempt"].get<std::string>().ends_with(".1"));
        EXPECT_NE(ending.output.find("pass 8/8"), std::string::npos) << "what the render says is relayed";
        EXPECT_NE(read_file(folder / "launch/log").find("attempt 1: "), std::string::npos);
        expect_nothing_left(folder);
    }
}

TEST(Launch, WhoeverIsKilledItGoesOnToTheSameBits) {
    const std::vector<std::pair<const char*, std::function<bool(const Started&)>>> victims = {
        {"rank 0", [](const Started& process) { return process.rank == 0; }},
        {"mpirun", is_mpirun},
        {"a worker", [](const Started& process) { return process.rank == 2; }},
        {"all", [](const Started&) { return true; }}};
    for (const auto& [name, which] : victims) {
        const fs::path folder = fresh_folder("run");
        Program program(launch(3) + render_arguments(folder));
        ASSERT_TRUE(program.wait_until([&] { return has_checkpoint(folder); }, kSoon)) << name;
        EXPECT_GT(kill_started(folder, which), 0) << name;
        const Ending ending = program.wait(kSoon);
        EXPECT_EQ(ending.code, 0) << name << ": " << ending.output;
        EXPECT_EQ(hashes_of(folder), plain_hashes()) << name;
        EXPECT_EQ(passes_done(folder), 8) << name;
        expect_nothing_left(folder);
    }
}

TEST(Launch, OneThatIsKilledAgainAndAgainComesToItsEnd) {
    const fs::path folder = fresh_folder("run");
    Program program(launch(2) + render_arguments(folder));
    for (int passes = 1; passes <= 5; passes += 2) {
        ASSERT_TRUE(program.wait_until([&] { return has_checkpoint(folder) && passes_done(folder) >= passes; }, kSoon));
        kill_started(folder, [](const Started&) { return true; });
    }
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(hashes_of(folder), plain_hashes());
    expect_nothing_left(folder);
}

TEST(Launch, WithoutACheckpointItBeginsAnew) {
    const fs::path folder = fresh_folder("run");
    Program program(launch(1) + render_arguments(folder, {"--spp", "255", "--set", "farm.checkpoint_seconds=0"}));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 3; }, kSoon));
    kill_started(folder, [](const Started&) { return true; });
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(hashes_of(folder), plain_hashes());
}

TEST(Launch, ASignalStopsItInOrder) {
    for (const int processes : {1, 3})
        for (const int number : {SIGINT, SIGTERM}) {
            const fs::path folder = fresh_folder("run");
            Program program(launch(processes) + render_arguments(folder, kEndless));
            ASSERT_TRUE(program.wait_until(
                [&] { return passes_done(folder) >= 3 && fs::exists(folder / "launch/status.json"); }, kSoon));
            program.signal(number);
            const Ending ending = program.wait(kSoon);
            EXPECT_EQ(ending.code, 3) << ending.output;
            EXPECT_EQ(read_summary(folder)["state"], "interrupted");
            EXPECT_TRUE(fs::exists(folder / "image.exr"));
            EXPECT_NE(ending.output.find("go on with treefarm launch -n " + std::to_string(processes) + " -- resume " +
                                         folder.string()),
                      std::string::npos)
                << ending.output;
            expect_nothing_left(folder);
        }
}

TEST(Launch, AStoppedOneGoesOnUnderLaunch) {
    const fs::path folder = fresh_folder("run");
    Program program(launch(2) + render_arguments(folder));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 4; }, kSoon));
    program.signal(SIGINT);
    ASSERT_EQ(program.wait(kSoon).code, 3);
    const Ending ending =
        Program(launch(3) + std::vector<std::string>{"resume", folder.string(), "--threads", "2"}).wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(hashes_of(folder), plain_hashes());
}

TEST(Launch, BadInputEndsItAtOnce) {
    const fs::path scene = fresh_folder("scene") / "bad.xml";
    std::ofstream(scene) << "<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>\n";
    for (const int processes : {1, 3}) {
        const fs::path folder = fresh_folder("parent") / "run";
        std::vector<std::string> command = render_arguments(folder);
        command[1] = scene.string();
        const Ending ending = Program(launch(processes) + command).wait(kSoon);
        EXPECT_EQ(ending.code, 2) << ending.output;
        EXPECT_NE(ending.output.find("bad.xml:"), std::string::npos) << ending.output;
        EXPECT_EQ(ending.output.find("again in"), std::string::npos) << ending.output;
        EXPECT_FALSE(fs::exists(folder)) << "nothing came of it";
        expect_nothing_left(folder);
    }
}

TEST(Launch, BadUsageIsSeenBeforeAnythingIsStarted) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{"render", "x.xml", "--no-such-option"}, "--no-such-option is no option of render"},
        {{"render", "x.xml", "--spp", "-3"}, "--spp"},
        {{"plan", "x.xml"}, "cannot be launched"},
        {{"resume", "/nowhere"}, "is no run directory"},
        {{"render", "x.xml", "--debug-sample", "1,2,3,4"}, "--debug-sample"},
        {{}, "has nothing to launch"}};
    for (const auto& [command, words] : wrong) {
        const Ending ending = Program(launch(2) + command).wait(kSoon);
        EXPECT_EQ(ending.code, 2) << ending.output;
        EXPECT_NE(ending.output.find(words), std::string::npos) << ending.output;
    }
}

TEST(Launch, ARenderThatIsThereIsNotReplaced) {
    const fs::path folder = fresh_folder("run");
    ASSERT_EQ(Program(plain(folder, {"--spp", "4"})).wait(kSoon).code, 0);
    const RunHashes before = hashes_of(folder);
    const Ending refused = Program(launch(1) + render_arguments(folder)).wait(kSoon);
    EXPECT_EQ(refused.code, 2) << refused.output;
    EXPECT_EQ(hashes_of(folder), before);
    EXPECT_FALSE(fs::exists(folder / "launch"));
    const Ending replaced =
        Program(launch(1) + render_arguments(folder) + std::vector<std::string>{"--overwrite"}).wait(kSoon);
    EXPECT_EQ(replaced.code, 0) << replaced.output;
    EXPECT_EQ(hashes_of(folder), plain_hashes());
}

TEST(Launch, TwoDoNotWatchOneFolder) {
    const fs::path folder = fresh_folder("run");
    Program first(launch(1) + render_arguments(folder, kEndless));
    ASSERT_TRUE(first.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    const Ending second = Program(launch(1) + render_arguments(folder)).wait(kSoon);
    EXPECT_EQ(second.code, 2);
    EXPECT_NE(second.output.find("another treefarm launch is at work"), std::string::npos) << second.output;
    first.signal(SIGINT);
    EXPECT_EQ(first.wait(kSoon).code, 3);
}

/// A program in mpirun's place, that does what it says.
fs::path false_mpirun(const std::string& script) {
    const fs::path path = fresh_folder("mpirun") / "mpirun";
    std::ofstream(path) << "#!/bin/sh\n" << script;
    fs::permissions(path, fs::perms::owner_all);
    return path;
}

/// The program's own part of mpirun's arguments.
const char* const kRun = "while [ \"$1\" != '" TREEFARM_PROGRAM "' ]; do shift; done\n\"$@\"\n";

TEST(Launch, WhatAlwaysDiesEndsWithOneLineThatSaysWhatToDo) {
    const fs::path folder = fresh_folder("run");
    const fs::path mpirun = false_mpirun("exit 7");
    const Ending ending =
        Program(launch(2, {"--restarts", "2", "--mpirun", mpirun.string()}) + render_arguments(folder)).wait(kSoon);
    EXPECT_EQ(ending.code, 1) << ending.output;
    EXPECT_NE(ending.output.find("the render's processes are gone in the start, before any sign of life; given up "
                                 "after 3 attempts in a row without progress, all of which ended there; no pass is "
                                 "kept in " +
                                 folder.string() + "; begin again with treefarm launch -n 2 --mpirun " +
                                 mpirun.string() + " --restarts 2 -- render "),
              std::string::npos)
        << ending.output;
    EXPECT_NE(read_file(folder / "launch/log").find("launcher: exit code 7"), std::string::npos);
    expect_nothing_left(folder);
}

TEST(Launch, ItsProcessesShareASecretWhereTheyAllSeeIt) {
    const fs::path folder = fresh_folder("run"), key = folder / "launch/key";
    Program program(launch(3) + render_arguments(folder));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    EXPECT_EQ(fs::status(key).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    const Ending sealed = program.wait(kSoon);
    EXPECT_EQ(sealed.code, 0) << sealed.output;
    EXPECT_EQ(sealed.output.find("authenticated"), std::string::npos) << sealed.output;
    EXPECT_EQ(hashes_of(folder), plain_hashes());
    EXPECT_FALSE(fs::exists(key));

    const fs::path other = fresh_folder("run");
    const std::string script = "rm " + (other / "launch/key").string() + "\nexec mpirun \"$@\"\n";
    const Ending open =
        Program(launch(2, {"--mpirun", false_mpirun(script).string()}) + render_arguments(other)).wait(kSoon);
    EXPECT_EQ(open.code, 0) << open.output;
    EXPECT_NE(open.output.find("launch/key: messages are not authenticated"), std::string::npos) << open.output;
    EXPECT_EQ(hashes_of(other), plain_hashes());
}

TEST(Launch, DeathsAtOneStageNameIt) {
    const fs::path folder = fresh_folder("run");
    Program begun(plain(folder, kEndless));
    ASSERT_TRUE(begun.wait_until([&] { return passes_done(folder) >= 9; }, kSoon));  // the next one takes seconds
    begun.signal(SIGINT);
    ASSERT_EQ(begun.wait(kSoon).code, 3);
    const std::vector<std::string> keeping_nothing = {"resume", folder.string(), "--threads",
                                                      "1",      "--set",         "farm.checkpoint_seconds=3600"};
    Program program(launch(1, {"--restarts", "1"}) + keeping_nothing);
    for (std::uint64_t dead = 0; program.running(); std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
        const nlohmann::json life = nlohmann::json::parse(read_file(folder / "launch/status.json"), nullptr, false);
        if (!life.is_object() || life["phase"] != "pass" || life["pid"] == dead) continue;
        dead = life["pid"];
        kill(static_cast<pid_t>(dead), SIGKILL);
    }
    const Ending ending = program.wait(1);
    EXPECT_EQ(ending.code, 1) << ending.output;
    EXPECT_NE(ending.output.find("in pass 10 on "), std::string::npos) << ending.output;
    EXPECT_NE(ending.output.find("given up after 2 attempts in a row without progress, all of which ended there; "
                                 "kept in "),
              std::string::npos)
        << ending.output;
    EXPECT_NE(ending.output.find("go on with treefarm launch -n 1 --restarts 1 -- resume " + folder.string()),
              std::string::npos);
}

TEST(Launch, TheExitCodeOfMpirunIsNotBelieved) {
    for (const char* code : {"exit 0", "exit 9"}) {
        const fs::path folder = fresh_folder("run");
        const std::string mpirun = false_mpirun(std::string(kRun) + code).string();
        const Ending ending = Program(launch(2, {"--mpirun", mpirun}) + render_arguments(folder)).wait(kSoon);
        EXPECT_EQ(ending.code, 0) << code << ending.output;
        EXPECT_EQ(hashes_of(folder), plain_hashes());
    }
    const fs::path folder = fresh_folder("run");
    const std::string mpirun = false_mpirun("exit 0").string();
    EXPECT_EQ(Program(launch(2, {"--mpirun", mpirun, "--restarts", "0"}) + render_arguments(folder)).wait(kSoon).code,
              1);
}

TEST(Launch, AnMpirunThatStaysAndIsDeafIsEndedAfterTheResult) {
    const fs::path folder = fresh_folder("run");
    const std::string mpirun =
        false_mpirun("trap '' TERM\n" + std::string(kRun) + "while :; do sleep 1; done\n").string();
    const Ending ending = Program(launch(2, {"--mpirun", mpirun}) + render_arguments(folder)).wait(kSoon);
    EXPECT_FALSE(ending.timed_out);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(hashes_of(folder), plain_hashes());
    EXPECT_EQ(ending.output.find("again in"), std::string::npos) << ending.output;
    expect_nothing_left(folder);
}

TEST(Launch, WhereItIsKilledItsRenderGoesWithIt) {
    const fs::path folder = fresh_folder("run");
    Program program(launch(3) + render_arguments(folder, kEndless));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 2; }, kSoon));
    program.signal(SIGKILL);
    program.wait(kSoon);
    for (int k = 0; k < 1500 && !started(folder).empty(); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(started(folder).empty());
    EXPECT_FALSE(leftovers().empty()) << "nobody was there to remove them";
    const Ending swept = Program({TREEFARM_PROGRAM, "launch", "--sweep"}).wait(kSoon);
    EXPECT_EQ(swept.code, 0) << swept.output;
    expect_nothing_left(folder);
}

TEST(Launch, AStudyGoesOnWhereItWas) {
    const fs::path folder = fresh_folder("study");
    fs::remove_all(folder);
    const fs::path file = fresh_folder("file") / "study.toml";
    std::ofstream(file) << "seeds = 4\n[budget]\nspp = 32\n[job]\nimage.width = 32\nimage.height = 32\n"
                        << "farm.heartbeat_seconds = 0.2\n[scene.box]\nfile = \"" << own_scene("cornell-box.xml")
                        << "\"\n[method.plain]\nguiding.type = \"none\"\n[reference]\nbudget.spp = 64\n";
    Program program(launch(2) +
                    std::vector<std::string>{"study", file.string(), "--dir", folder.string(), "--threads", "1"});
    const auto cells = [&] {
        int count = 0;
        if (fs::exists(folder / "cells"))
            for (const auto& entry : fs::directory_iterator(folder / "cells"))
                count += fs::exists(entry.path() / "cell.json");
        return count;
    };
    ASSERT_TRUE(program.wait_until([&] { return cells() >= 1; }, kSoon)) << program.wait(1).output;
    kill_started(folder, [](const Started&) { return true; });
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(cells(), 4);
    EXPECT_TRUE(fs::exists(folder / "report.html"));
    expect_nothing_left(folder);
}

}  // namespace
}  // namespace treefarm::test
