// SPDX-License-Identifier: Apache-2.0
// treefarm launch where files and folders vanish beneath it: the render still ends with the bits of one left alone.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <set>

#include "tests/mpi/program.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {
namespace {

constexpr double kDeadline = 180;  ///< seconds; what is meant is "not never"

std::vector<std::string> launched(int processes, const fs::path& folder,
                                  const std::vector<std::string>& options = {"--spp", "255"},
                                  const std::vector<std::string>& of_launch = {}) {
    return std::vector<std::string>{TREEFARM_PROGRAM, "launch", "-n", std::to_string(processes)} + of_launch +
           std::vector<std::string>{"--",
                                    "render",
                                    own_scene("cornell-box.xml"),
                                    "-D",
                                    "size=48",
                                    "--run-dir",
                                    folder.string(),
                                    "--threads",
                                    "1",
                                    "--set",
                                    "farm.checkpoint_seconds=0.001",
                                    "--set",
                                    "farm.heartbeat_seconds=0.2"} +
           options;
}

/// Folders of living launches.
std::set<fs::path> launch_folders(const fs::path& parent) {
    std::set<fs::path> found;
    for (const auto& entry : fs::directory_iterator(parent))
        if (entry.path().filename().string().starts_with("treefarm-launch-")) found.insert(entry.path());
    return found;
}

/// Process of the coordinator that writes a run directory; 0: unknown.
pid_t coordinator_of(const fs::path& folder) {
    const nlohmann::json status = nlohmann::json::parse(read_file(folder / "status.json"), nullptr, false);
    return status.is_object() ? status.value("pid", 0) : 0;
}

TEST(LaunchFaults, WhateverVanishesBeforeADeathItGoesOn) {
    const fs::path whole = fresh_folder("whole");
    ASSERT_EQ(Program(launched(1, whole)).wait(kDeadline).code, 0);
    const bool has_namespaces =
        Program({"unshare", "--pid", "--fork", "--mount-proc", "true"}).wait(kDeadline).code == 0;
    const std::vector<std::string> sweep = {"unshare",        "--pid",  "--fork", "--mount-proc",
                                            TREEFARM_PROGRAM, "launch", "--sweep"};
    const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> faults = {
        {"its run directory",
         [](const fs::path& folder) {
             std::error_code made_again;  // by the render, meanwhile
             fs::remove_all(folder, made_again);
         }},
        {"its folder in shared memory",
         [](const fs::path&) {
             for (const fs::path& own : launch_folders("/dev/shm"))
                 fs::remove_all(own);
         }},
        {"nothing, since a launch in another container sees that it lives", [&](const fs::path&) {
             const std::set<fs::path> before = launch_folders("/dev/shm");
             EXPECT_EQ(before.size(), 1u);
             EXPECT_EQ(Program(sweep).wait(kDeadline).code, has_namespaces ? 0 : 1);
             EXPECT_EQ(launch_folders("/dev/shm"), before);
         }}};
    for (const auto& [name, act] : faults) {
        const fs::path folder = fresh_folder("run");
        Program program(launched(2, folder));
        ASSERT_TRUE(program.wait_until([&] { return has_checkpoint(folder); }, kDeadline)) << name;
        const pid_t coordinator = coordinator_of(folder);
        ASSERT_GT(coordinator, 0) << name;
        act(folder);
        EXPECT_EQ(kill(coordinator, SIGKILL), 0) << name;
        const Ending ending = program.wait(kDeadline);
        EXPECT_EQ(ending.code, 0) << name << ": " << ending.output;
        EXPECT_EQ(hashes_of(folder), hashes_of(whole)) << name;
        EXPECT_TRUE(launch_folders("/dev/shm").empty()) << name;
        EXPECT_FALSE(fs::exists(folder / "launch/key")) << name;
    }
}

TEST(LaunchFaults, AHostThatDoesNotAnswerIsToldEverywhere) {
    const fs::path folder = fresh_folder("run"), hosts = fresh_folder("hosts") / "hosts";
    std::ofstream(hosts) << "localhost slots=2\nnode9.invalid slots=2\n";
    setenv("OMPI_MCA_plm_rsh_agent", "/bin/false", 1);
    const Ending ending = Program(launched(4, folder, {"--spp", "4"}, {"--hostfile", hosts.string()})).wait(kDeadline);
    unsetenv("OMPI_MCA_plm_rsh_agent");
    EXPECT_EQ(ending.code, 0) << ending.output;
    for (const char* words : {"warning: node9.invalid does not answer to /bin/false: 1 of 2 hosts is left",
                              "4 processes on 2 slots that are left: 4 on localhost"})
        for (const std::string& text : {ending.output, read_file(folder / "launch/log"), read_file(folder / "log.txt")})
            EXPECT_NE(text.find(words), std::string::npos) << text;
}

TEST(LaunchFaults, AFolderForTemporaryFilesThatTakesNoneIsToldAtOnce) {
    const fs::path folder = fresh_folder("parent") / "run";
    const std::vector<std::string> elsewhere = {"env", "TMPDIR=/proc"};
    const Ending ending = Program(elsewhere + launched(2, folder)).wait(kDeadline);
    EXPECT_EQ(ending.code, 2) << ending.output;
    EXPECT_NE(ending.output.find("/proc: cannot hold Open MPI's temporary files"), std::string::npos) << ending.output;
    EXPECT_FALSE(fs::exists(folder));
}

/// mpirun looks for ssh even where it needs none.
TEST(LaunchFaults, NoSearchPathIsNeededOnOneHost) {
    const fs::path folder = fresh_folder("run");
    const std::vector<std::string> without = {"env", "-u", "PATH"};
    const Ending ending = Program(without + launched(2, folder, {"--spp", "4"})).wait(kDeadline);
    EXPECT_EQ(ending.code, 0) << ending.output;
}

}  // namespace
}  // namespace treefarm::test
