// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/mpi/program.h"
#include "tests/support/support.h"

// How jobs start when not everybody is there.

namespace treefarm::test {
namespace {

std::vector<std::string> render_to_start(const std::filesystem::path& folder,
                                         const std::vector<std::string>& options = {}) {
    return std::vector<std::string>{TREEFARM_PROGRAM,
                                    "render",
                                    own_scene("cornell-box.xml"),
                                    "-D",
                                    "size=32",
                                    "--spp",
                                    "4",
                                    "--threads",
                                    "1",
                                    "--start-seconds",
                                    "3",
                                    "--run-dir",
                                    folder.string()} +
           options;
}

/// MPI_Init waits for a process that left before it came there, and would for ever.
TEST(Starting, AProcessThatNeverComesEndsTheJobWithAMessage) {
    for (const char* leaver : {"true", "false"})
        for (const std::vector<std::string>& transport :
             {std::vector<std::string>{}, std::vector<std::string>{"--mca", "btl", "tcp,self"}}) {
            const auto folder = fresh_folder("run");
            const Ending ending = Program(mpirun(2, {"--enable-recovery"}) + transport + render_to_start(folder) +
                                          std::vector<std::string>{":", "-n", "1", leaver})
                                      .wait(kSoon);
            EXPECT_FALSE(ending.timed_out) << ending.output;
            EXPECT_NE(ending.output.find("did not come together"), std::string::npos) << ending.output;
            EXPECT_FALSE(std::filesystem::exists(folder / "summary.json"));
        }
}

TEST(Starting, ARankThatDiesInMpiInitEndsTheJobWithAMessage) {
    for (const int victim : {0, 1}) {
        // A process that takes part in nothing keeps the others in MPI_Init until it is killed there.
        Program program(mpirun(2, {"--enable-recovery"}) + render_to_start(fresh_folder("run")) +
                        std::vector<std::string>{":", "-n", "1", "sleep", "20"});
        ASSERT_TRUE(program.wait_until([&] { return program.rank(victim) > 0 && program.rank(2) > 0; }, kSoon));
        kill(program.rank(victim), SIGKILL);
        kill(program.rank(2), SIGKILL);
        const Ending ending = program.wait(kSoon);
        EXPECT_FALSE(ending.timed_out) << ending.output;
        EXPECT_NE(ending.output.find("did not come together"), std::string::npos) << ending.output;
    }
}

TEST(Starting, TheHeadOfTheChainMayDieBeforeTheSceneIsSent) {
    const auto calm = fresh_folder("calm");
    ASSERT_EQ(Program(render_to_start(calm)).wait(kSoon).code, 0);
    const auto folder = fresh_folder("run");
    Program program(mpirun(4, {"--enable-recovery"}) +
                    render_to_start(folder, {"--set", "farm.heartbeat_seconds=0.2"}));
    ASSERT_TRUE(program.wait_until([&] { return std::filesystem::exists(folder / "log.txt"); }, kSoon));
    kill(program.rank(1), SIGKILL);
    const Ending ending = program.wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    EXPECT_EQ(read_summary(folder)["image_hash"], read_summary(calm)["image_hash"]) << ending.output;
}

}  // namespace
}  // namespace treefarm::test
