// SPDX-License-Identifier: Apache-2.0
// Processes of a render that get SIGTERM, as from a batch system that takes a host away.
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/mpi/program.h"
#include "tests/support/support.h"

namespace treefarm::test {
namespace {

std::vector<std::string> render_to_leave(const fs::path& folder) {
    return {TREEFARM_PROGRAM,
            "render",
            own_scene("cornell-box.xml"),
            "-D",
            "size=48",
            "--spp",
            "400",
            "--run-dir",
            folder.string(),
            "--threads",
            "1"};
}

TEST(Leave, AWorkerThatGetsSigtermLeavesAndTheImageIsTheSame) {
    const fs::path whole = fresh_folder("whole"), folder = fresh_folder("run");
    ASSERT_EQ(Program(render_to_leave(whole)).wait(kSoon).code, 0);
    Program program(mpirun(3) + render_to_leave(folder));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 2; }, kSoon));
    const pid_t worker = program.rank(2);
    ASSERT_GT(worker, 0);
    kill(worker, SIGTERM);
    const Ending ending = program.wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("leaves, as it was told"), std::string::npos) << ending.output;
    EXPECT_EQ(ending.output.find("silent"), std::string::npos) << ending.output;
    EXPECT_EQ(hashes_of(folder), hashes_of(whole));
    EXPECT_EQ(read_summary(folder)["state"], "done");
}

}  // namespace
}  // namespace treefarm::test
