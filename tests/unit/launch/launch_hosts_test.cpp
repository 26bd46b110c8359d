// SPDX-License-Identifier: Apache-2.0
// Hosts of treefarm launch: those that do not answer are named, and a hostfile is no way to run a command.
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "coordinator/launch/host_pool.h"
#include "coordinator/launch/launch_plan.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

/// Launches with an agent that reaches node1 alone, and an mpirun that is never started.
class LaunchHosts : public test::FolderTest {
  protected:
    void SetUp() override {
        const fs::path agent = write("agent",
                                     "#!/bin/sh\n[ $1 = node1 ] && exit 0\necho \"debug\"\n"
                                     "printf 'agent: no route\\033[31m to %s\\r\\n' $1 >&2\nexit 255\n");
        fs::permissions(agent, fs::perms::owner_all);
        setenv("OMPI_MCA_plm_rsh_agent", agent.c_str(), 1);
        setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
        setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
        options_.mpirun = "/bin/true";
        agent_ = agent.string();
    }
    void TearDown() override { unsetenv("OMPI_MCA_plm_rsh_agent"); }

    StartPlan plan(const std::string& hosts, int processes = 0) {
        options_.hostfile = write("hosts", hosts).string();
        options_.processes = processes;
        return LaunchPlanner(options_).plan(folder_ / "hostfile-1");
    }

    LaunchOptions options_;
    std::string agent_;
};

TEST_F(LaunchHosts, OneThatDoesNotAnswerIsNamedWithTheReason) {
    const StartPlan two = plan("localhost slots=2\nnode9\n");
    EXPECT_EQ(two.warnings, std::vector<std::string>{"node9 does not answer to " + agent_ +
                                                     ": 1 of 2 hosts is left (agent: no route?[31m to node9)"});
    EXPECT_EQ(two.processes, 2);
    EXPECT_EQ(plan("localhost\nnode1\nnode9\nnode8\n").warnings.at(0),
              "node8, node9 do not answer to " + agent_ + ": 2 of 4 hosts are left (agent: no route?[31m to node8)");
    EXPECT_TRUE(plan("localhost\nnode1\n").warnings.empty());
}

TEST_F(LaunchHosts, ProcessesThatMustShareWhatIsLeftAreCounted) {
    const StartPlan one = plan("localhost slots=2\nnode9 slots=2\n", 4);
    ASSERT_EQ(one.warnings.size(), 2u);
    EXPECT_EQ(one.warnings[1], "4 processes on 2 slots that are left: 4 on localhost");
    const StartPlan two = plan("localhost slots=2\nnode1 slots=2\nnode9 slots=3\n", 7);
    ASSERT_EQ(two.warnings.size(), 2u);
    EXPECT_EQ(two.warnings[1], "7 processes on 4 slots that are left: 4 on localhost, 3 on node1");
    EXPECT_EQ(plan("localhost slots=2\nnode1 slots=2\nnode9\n", 4).warnings.size(), 1u) << "there are slots for all";
    EXPECT_TRUE(plan("localhost slots=2\nnode1\n", 9).warnings.empty()) << "as it was asked for";
}

TEST_F(LaunchHosts, OneThatLostItsWorkersTwiceIsNamedToo) {
    options_.hostfile = write("hosts", "localhost\nnode1\n").string();
    LaunchPlanner planner(options_);
    planner.note_end({{"node1", true}});
    EXPECT_TRUE(planner.plan(folder_ / "hostfile-1").warnings.empty());
    planner.note_end({{"node1", true}});
    EXPECT_EQ(planner.plan(folder_ / "hostfile-1").warnings,
              std::vector<std::string>{"node1 lost its workers in two attempts: it is left out of this one"});
}

TEST_F(LaunchHosts, NoAnswerAtAllSaysWhy) {
    try {
        plan("node8\n");
        FAIL();
    } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("no host answers"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("no route?[31m to node8"), std::string::npos) << error.what();
    }
}

TEST_F(LaunchHosts, AnOptionIsNoHost) {
    const fs::path ran = folder_ / "ran";
    for (const std::string& name : {"-oProxyCommand=touch${IFS}" + ran.string(), std::string("root@-oProxyCommand=x"),
                                    std::string("-"), std::string("--help")}) {
        try {
            plan("localhost\n  " + name + " slots=2\n");
            FAIL() << name;
        } catch (const InputError& error) {
            EXPECT_EQ(error.where(), (Location{options_.hostfile, 2, 3}));
            EXPECT_NE(error.problem().find("is no host: ssh would take it for an option"), std::string::npos);
        }
    }
    EXPECT_FALSE(fs::exists(ran));
    options_.hostfile.clear();
    options_.network = "-x";
    EXPECT_THROW(LaunchPlanner{options_}, InputError);
}

TEST_F(LaunchHosts, AFolderForTemporaryFilesThatTakesNoneIsAnErrorAtOnce) {
    options_.processes = 2;
    setenv("TMPDIR", "/proc", 1);
    try {
        LaunchPlanner planner(options_);
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().file, "/proc");
        EXPECT_NE(error.problem().find("cannot hold Open MPI's temporary files: "), std::string::npos);
        EXPECT_EQ(error.cure(), "set TMPDIR to a folder that takes files");
    }
    unsetenv("TMPDIR");
}

}  // namespace
}  // namespace treefarm
