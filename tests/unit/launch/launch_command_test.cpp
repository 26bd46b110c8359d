// SPDX-License-Identifier: Apache-2.0
// Launchers that MPI cannot talk to start every task as an MPI world of its own: each would render everything.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/command.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

class LoneTasks : public testing::Test {
  protected:
    void SetUp() override { std::filesystem::remove_all(folder_); }

    test::Ended render(const std::string& environment, const std::string& before = "") const {
        return test::run_command("env -u OMPI_COMM_WORLD_RANK -u PMIX_RANK " + environment +
                                 " '" TREEFARM_PROGRAM "' " + before + "render " + test::own_scene("cornell-box.xml") +
                                 " -D size=8 --spp 1 --quiet --threads 1 --run-dir '" + folder_ + "'");
    }

    void expect_refused(const std::string& launcher, const std::string& number, const std::string& cure) const {
        const test::Ended first = render(launcher + " " + number + "=0");
        EXPECT_EQ(first.code, 2) << first.output;
        EXPECT_NE(first.output.find("started 4 unconnected tasks"), std::string::npos) << first.output;
        EXPECT_NE(first.output.find(cure), std::string::npos) << first.output;
        const test::Ended third = render(launcher + " " + number + "=2");
        EXPECT_EQ(third.code, 2);
        EXPECT_EQ(third.output, "") << "one of them speaks";
        EXPECT_FALSE(std::filesystem::exists(folder_)) << "nothing is written";
    }

    const std::string folder_ = (test::fresh_test_folder() / "run").string();
};

TEST_F(LoneTasks, OfSrunWithoutPmixAreRefused) {
    expect_refused("SLURM_STEP_ID=0 SLURM_STEP_NUM_TASKS=4 SLURM_NTASKS=9", "SLURM_PROCID", "srun --mpi=pmix");
    expect_refused("SLURM_STEP_ID=0 SLURM_NTASKS=4", "SLURM_PROCID", "mpirun -n 4 treefarm");
    expect_refused("SLURM_STEP_ID=0 SLURM_STEP_NUM_TASKS=4 SLURM_PROCID=0 PMI_SIZE=4", "PMI_RANK", "srun --mpi=pmix");
}

TEST_F(LoneTasks, OfAnotherMpiAreRefused) {
    expect_refused("PMI_SIZE=4", "PMI_RANK", "mpirun -n 4 treefarm");
    const test::Ended study = test::run_command("env PMI_SIZE=4 PMI_RANK=0 '" TREEFARM_PROGRAM "' study nothing.toml");
    EXPECT_EQ(study.code, 2);
    EXPECT_NE(study.output.find("started 4 unconnected tasks"), std::string::npos) << study.output;
}

/// One task, a batch script, a shell of salloc.
TEST_F(LoneTasks, OneProcessIsLegal) {
    for (const char* environment :
         {"SLURM_STEP_ID=0 SLURM_STEP_NUM_TASKS=1 SLURM_NTASKS=4 SLURM_PROCID=0",
          "SLURM_PROCID=0 SLURM_NTASKS=4 ENVIRONMENT=BATCH", "SLURM_NTASKS=4", "PMI_SIZE=1 PMI_RANK=0"}) {
        const test::Ended ended = render(environment);
        EXPECT_EQ(ended.code, 0) << environment << "\n" << ended.output;
        std::filesystem::remove_all(folder_);
    }
}

}  // namespace
}  // namespace treefarm
