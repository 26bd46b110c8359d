// SPDX-License-Identifier: Apache-2.0
// Parts of treefarm launch: which command starts an attempt, on which hosts, and what a coordinator tells of its life.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>

#include "common/comm/run_key.h"
#include "common/runs/run_files.h"
#include "coordinator/launch/host_keys.h"
#include "coordinator/launch/host_pool.h"
#include "coordinator/launch/host_probe.h"
#include "coordinator/launch/start_command.h"
#include "coordinator/run/folder_content.h"
#include "coordinator/run/sign_of_life.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += " " + word;
    return text + " ";
}

std::string command(const StartPlan& plan) {
    return joined(start_command(plan, {"render", "x.xml"}));
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A host is a folder here: its own temporary files, and a shell.
TEST(HostKeys, ASecretReachesAHostByStandardInputAndIsTakenBack) {
    const fs::path folder = test::fresh_test_folder();
    fs::create_directories(folder / "node7");
    const fs::path agent = folder / "agent", key = folder / "key";
    std::ofstream(agent) << "#!/bin/sh\nhost=$1\nshift\necho \"$*\" >> " << folder.string()
                         << "/asked\nTMPDIR=" << folder.string() << "/$host exec sh -c \"$*\"\n";
    fs::permissions(agent, fs::perms::owner_all);
    write_run_key(key);
    setenv("OMPI_MCA_plm_rsh_agent", agent.c_str(), 1);
    const fs::path there = folder / "node7" / host_key_file("abc.1").filename();
    {
        const HostKeys keys({{"node7", 1, "node7"}, {"localhost", 1, "localhost"}}, key, "abc.1");
        EXPECT_EQ(read_run_key(there), read_run_key(key)) << "and nobody else may read it";
        EXPECT_EQ(failing_hosts({{"node8", 1, "node8"}}, "cat > $TMPDIR/x", 10.0, key), std::set<std::string>{"node8"});
    }
    EXPECT_FALSE(fs::exists(there));
    std::ifstream asked(folder / "asked");
    const std::string commands{std::istreambuf_iterator<char>(asked), {}};
    std::ifstream secret(key, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(secret), {}};
    EXPECT_EQ(commands.find(bytes), std::string::npos);
    unsetenv("OMPI_MCA_plm_rsh_agent");
}

TEST(StartCommand, OneProcessNeedsNoLauncher) {
    EXPECT_EQ(command({.starter = Starter::alone, .program = "/bin/treefarm"}), " /bin/treefarm render x.xml ");
}

TEST(StartCommand, OneHostTalksToItselfOnly) {
    StartPlan plan{
        .program = "/bin/treefarm", .processes = 3, .temporary = "/tmp/own", .shared_memory = "/dev/shm/own"};
    const std::string text = command(plan);
    EXPECT_TRUE(text.starts_with(" mpirun -n 3 ")) << text;
    EXPECT_TRUE(text.ends_with(" -x TREEFARM_ATTEMPT /bin/treefarm render x.xml ")) << text;
    for (const char* part : {" --enable-recovery ", " --mca btl vader,self ", " --mca oob_tcp_if_include lo ",
                             " --mca orte_tmpdir_base /tmp/own ", " --mca btl_vader_backing_directory /dev/shm/own "})
        EXPECT_TRUE(has(text, part)) << part << text;
    plan.recovery = false;
    EXPECT_FALSE(has(command(plan), "--enable-recovery"));
}

TEST(StartCommand, HostsAreUsedAsTheyAreNamed) {
    StartPlan plan{.program = "/bin/treefarm", .processes = 3, .hostfile = "run/hosts", .network = "10.0.0.0/24"};
    const std::string text = command(plan);
    for (const char* part : {" --hostfile run/hosts ", " --map-by node ", " --mca btl_tcp_if_include 10.0.0.0/24 ",
                             " --mca oob_tcp_if_include 10.0.0.0/24 ", " --mca oob_tcp_keepalive_time 10 "})
        EXPECT_TRUE(has(text, part)) << part << text;
    EXPECT_FALSE(has(text, "--oversubscribe"));
    EXPECT_FALSE(has(text, " lo "));
    plan.oversubscribed = true;
    EXPECT_TRUE(has(command(plan), " --oversubscribe "));
}

TEST(StartCommand, WithoutSshMpirunMayNotLookForIt) {
    StartPlan plan{.program = "/bin/treefarm", .processes = 3, .no_agent = true};
    EXPECT_TRUE(has(command(plan), " --mca plm isolated ")) << command(plan);
    plan.no_agent = false;
    EXPECT_FALSE(has(command(plan), "plm")) << command(plan);
}

TEST(StartCommand, WarningsReachTheCoordinator) {
    StartPlan plan{.program = "/bin/treefarm", .processes = 3};
    EXPECT_FALSE(has(command(plan), kWarningsVariable)) << command(plan);
    plan.warnings = {"node9 does not answer"};
    EXPECT_TRUE(has(command(plan), " -x TREEFARM_LAUNCH_WARNINGS ")) << command(plan);
}

TEST(StartCommand, MpirunKnowsTheHostsOfAnAllocation) {
    const std::string text = command({.program = "/bin/treefarm", .processes = 3, .one_host = false});
    EXPECT_TRUE(has(text, " --mca btl tcp,vader,self ")) << text;
    EXPECT_FALSE(has(text, " lo ")) << text;
    EXPECT_FALSE(has(text, "--hostfile")) << text;
}

TEST(StartCommand, SlurmStartsByPmix) {
    StartPlan plan{.starter = Starter::srun, .program = "/bin/treefarm", .processes = 9};
    EXPECT_EQ(command(plan),
              " srun --mpi=pmix -n 9 --cpu-bind=none --overcommit --export=ALL -K0 --no-kill /bin/treefarm render "
              "x.xml ");
    plan.network = "10.0.0.0/24";
    EXPECT_TRUE(has(command(plan), " --export=ALL,OMPI_MCA_btl_tcp_if_include=10.0.0.0/24 ")) << command(plan);
}

const char* const kHosts = "# ours\nnode1 slots=2\n\nnode2.cluster.org slots=4 max-slots=8  # large\n  node3\n";

std::vector<std::string> names(const std::vector<HostLine>& hosts) {
    std::vector<std::string> names;
    for (const HostLine& line : hosts)
        names.push_back(line.host);
    return names;
}

using Names = std::vector<std::string>;

TEST(HostPool, ReadsAHostfileAndKeepsItsLines) {
    const std::vector<HostLine> hosts = parse_hostfile(kHosts);
    EXPECT_EQ(names(hosts), (Names{"node1", "node2.cluster.org", "node3"}));
    EXPECT_EQ(hosts[0].slots, 2);
    EXPECT_EQ(hosts[1].slots, 4);
    EXPECT_EQ(hosts[2].slots, 1);
    EXPECT_EQ(hostfile_text(hosts), "node1 slots=2\nnode2.cluster.org slots=4 max-slots=8  # large\n  node3\n");
    EXPECT_TRUE(parse_hostfile("# nobody\n\n").empty());
}

TEST(HostPool, ThisHostComesFirst) {
    EXPECT_EQ(names(HostPool(parse_hostfile(kHosts), "node2").choose({})),
              (Names{"node2.cluster.org", "node1", "node3"}));
    EXPECT_EQ(names(HostPool(parse_hostfile(kHosts), "elsewhere").choose({})),
              (Names{"node1", "node2.cluster.org", "node3"}));
    EXPECT_FALSE(is_same_host("10.0.0.1", "10.0.0.2"));
}

TEST(HostPool, WhoDoesNotAnswerIsLeftOutThisTime) {
    const HostPool pool(parse_hostfile(kHosts), "node1");
    EXPECT_EQ(names(pool.choose({"node3"})), (Names{"node1", "node2.cluster.org"}));
    EXPECT_EQ(pool.choose({}).size(), 3u);
}

TEST(HostPool, AHostThatLosesItsWorkersTwiceRestsForOneAttempt) {
    HostPool pool(parse_hostfile(kHosts), "node1");
    const std::vector<LifeWorker> lost = {{"node1", false}, {"node2", true}, {"node3", false}},
                                  whole = {{"node1", false}};
    pool.note_end(lost);
    EXPECT_EQ(pool.choose({}).size(), 3u) << "once may be chance";
    pool.note_end(whole);
    pool.note_end(lost);
    EXPECT_EQ(names(pool.choose({})), (Names{"node1", "node3"}));
    pool.note_end(whole);
    EXPECT_EQ(pool.choose({}).size(), 3u);
}

class SignOfLifeTest : public testing::Test {
  protected:
    std::optional<LifeStatus> read() const {
        std::ifstream file(file_, std::ios::binary);
        return parse_life_status(std::string(std::istreambuf_iterator<char>(file), {}));
    }
    /// Waits for a sign that fulfils a condition; nothing if it does not come.
    std::optional<LifeStatus> wait_for(const std::function<bool(const LifeStatus&)>& condition) const {
        for (int k = 0; k < 3000; ++k) {
            if (const auto status = read(); status && condition(*status)) return status;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return std::nullopt;
    }

    const fs::path folder_ = test::fresh_test_folder(), file_ = folder_ / "status.json";
};

TEST_F(SignOfLifeTest, BeatsByItselfAndTellsWhatItSees) {
    SignOfLife life({"ab.2", file_});
    EXPECT_FALSE(fs::exists(file_)) << "not before it begins";
    life.begin();
    ASSERT_TRUE(wait_for([](const LifeStatus& s) { return s.attempt == "ab.2" && s.beat >= 1 && s.pid == getpid(); }));
    life.see({4, 3, 100});
    life.see_workers([] { return std::vector<LifeWorker>{{"node2", true}}; });
    const auto first = wait_for([](const LifeStatus& s) { return s.phase == LifePhase::pass; });
    ASSERT_TRUE(first);
    EXPECT_EQ(first->pass, 4u);
    EXPECT_EQ(first->passes, 3u);
    EXPECT_EQ(first->workers, (std::vector<LifeWorker>{{"node2", true}}));
    const auto later = wait_for([&](const LifeStatus& s) { return s.beat > first->beat; });
    ASSERT_TRUE(later);
    EXPECT_EQ(later->progress, first->progress) << "to live is no progress";
    life.see({4, 3, 101});
    EXPECT_TRUE(wait_for([&](const LifeStatus& s) { return s.progress > later->progress; }));
    life.end(4);
    EXPECT_EQ(read()->code, 4) << "at once";
}

TEST_F(SignOfLifeTest, AFolderThatIsGoneEndsNothing) {
    SignOfLife life({"ab.2", folder_ / "gone" / "status.json"});
    life.begin();
    life.see({});
    life.end(0);
    EXPECT_FALSE(fs::exists(folder_ / "gone"));
}

/// The error output leads to treefarm launch.
TEST_F(SignOfLifeTest, WithoutItsFolderItBeatsInTheErrorOutput) {
    testing::internal::CaptureStderr();
    {
        SignOfLife life({"ab.2", folder_ / "gone" / "status.json"});
        life.begin();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        life.end(4);
    }
    const std::string said = testing::internal::GetCapturedStderr();
    ASSERT_EQ(said.find(kLifeMark), 0u) << said;
    const auto last = parse_life_status(said.substr(said.rfind(kLifeMark) + 1));
    ASSERT_TRUE(last) << said;
    EXPECT_EQ(last->attempt, "ab.2");
    EXPECT_EQ(last->code, 4);
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
    EXPECT_FALSE(read->ended_by_launcher);
    status.ended_by_launcher = true;
    EXPECT_TRUE(parse_life_status(life_status_text(status))->ended_by_launcher);
}

TEST(LifeStatus, WhatIsNoneIsNone) {
    const std::string whole = life_status_text({});
    for (std::size_t k = 0; k + 2 < whole.size(); ++k)
        EXPECT_FALSE(parse_life_status(whole.substr(0, k))) << k;
    EXPECT_FALSE(parse_life_status("[]"));
    EXPECT_FALSE(parse_life_status("{\"attempt\": 3}"));
}

TEST(LifeAttempt, ComesThroughTheEnvironment) {
    const LifeAttempt attempt = parse_attempt(attempt_text({"0a.12", "/a:b/status.json"}));
    EXPECT_EQ(attempt.name, "0a.12");
    EXPECT_EQ(attempt.file, "/a:b/status.json");
    EXPECT_EQ(parse_attempt("nonsense").name, "");
}

TEST(LaunchFolder, IsNothingThatARenderWouldReplace) {
    const fs::path folder = test::fresh_test_folder();
    fs::create_directories(folder / kLaunchFolder);
    EXPECT_EQ(folder_content(folder), FolderContent::nothing);
    std::ofstream(folder / "mine");
    EXPECT_EQ(folder_content(folder), FolderContent::other);
}

}  // namespace
}  // namespace treefarm
