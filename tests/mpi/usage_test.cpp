// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/mpi/program.h"
#include "tests/support/support.h"

// Ranks of one job that were typed differently.

namespace treefarm::test {
namespace {

TEST(Usage, ARankWithABadOptionIsNamed) {
    const auto folder = fresh_folder("run");
    const std::vector<std::string> good = {
        TREEFARM_PROGRAM, "render",       own_scene("cornell-box.xml"), "-D", "size=8", "--spp", "1000000",
        "--run-dir",      folder.string()};
    const Ending ending =
        Program(mpirun(1) + good + std::vector<std::string>{":", "-n", "1"} + good + std::vector<std::string>{"--bad"})
            .wait(kSoon);
    EXPECT_FALSE(ending.timed_out) << ending.output;
    EXPECT_NE(ending.code, 0);
    EXPECT_NE(ending.output.find("treefarm: rank 1: --bad is no option of render"), std::string::npos) << ending.output;
}

}  // namespace
}  // namespace treefarm::test
