// SPDX-License-Identifier: Apache-2.0
// treefarm join: whoever comes to a running render, or is killed again, it has the bits of one that was left alone.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <deque>
#include <fstream>
#include <random>
#include <thread>

#include "common/base/error.h"
#include "common/comm/join_ticket.h"
#include "common/comm/tcp_socket.h"
#include "common/runs/run_files.h"
#include "tests/mpi/program.h"

namespace treefarm::test {
namespace {

#ifdef NDEBUG
const std::string kSpp = "1016";  // some seconds
#else
const std::string kSpp = "252";
#endif

std::vector<std::string> render_for_joiners(const fs::path& folder, const std::vector<std::string>& options = {},
                                            const std::string& spp = kSpp) {
    return small_render(folder, spp, {"--set", "farm.heartbeat_seconds=0.2"}) + options;
}

const std::vector<std::string> kJoinable = {"--set", "farm.join=true"};

std::vector<std::string> join(const std::vector<std::string>& options) {
    return std::vector<std::string>{TREEFARM_PROGRAM, "join", "--threads", "1"} + options;
}

const RunHashes& left_alone() {
    static const RunHashes truth = [] {
        const fs::path folder = fresh_folder("alone");
        const Ending ending = Program(render_for_joiners(folder)).wait(kSoon);
        EXPECT_EQ(ending.code, 0) << ending.output;
        EXPECT_FALSE(fs::exists(folder / kTicketFileName)) << "nobody asked for it";
        return hashes_of(folder);
    }();
    return truth;
}

/// Workers that take part, as status.json says.
int workers_in(const fs::path& folder) {
    std::ifstream file(folder / "status.json");
    const nlohmann::json status = nlohmann::json::parse(file, nullptr, false);
    return status.is_object() ? status.value("workers", 0) : 0;
}

/// Number of passes after which something happens.
int draw_moment() {
    static std::mt19937 random{std::random_device{}()};
    const int passes = std::uniform_int_distribution<>(0, 3)(random);
    ::testing::Test::RecordProperty("after_passes", passes);
    return passes;
}

bool has_come_to(const fs::path& folder, int passes) {
    return fs::exists(folder / kTicketFileName) && passes_done(folder) >= passes;
}

void expect_done(const fs::path& folder, const Ending& ending) {
    EXPECT_FALSE(ending.timed_out) << ending.output;
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(hashes_of(folder), left_alone());
    EXPECT_FALSE(fs::exists(folder / kTicketFileName)) << "there is nothing to join any more";
}

TEST(Join, ARenderThatOthersJoinHasTheSameBits) {
    for (const bool mpi : {true, false}) {
        const fs::path folder = fresh_folder("run");
        Program program((mpi ? mpirun(2) : std::vector<std::string>()) + render_for_joiners(folder, kJoinable));
        const int moment = draw_moment();
        ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, moment); }, kSoon));
        Program guest(join({folder.string()}));
        EXPECT_TRUE(program.wait_until([&] { return workers_in(folder) == 2; }, kSoon)) << moment;
        expect_done(folder, program.wait(kSoon));
        const Ending ending = guest.wait(kSoon);
        EXPECT_EQ(ending.code, 0) << ending.output;
        EXPECT_NE(ending.output.find("the render is over"), std::string::npos) << ending.output;
        EXPECT_EQ(read_summary(folder)["farm"]["workers"].size(), 2u);
    }
}

TEST(Join, OneOfTwoIsKilledAndNothingElseHappens) {
    const fs::path folder = fresh_folder("run");
    Program program(mpirun(2) + render_for_joiners(folder, kJoinable));
    const int moment = draw_moment();
    ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, moment); }, kSoon));
    Program killed(join({folder.string()})), other(join({folder.string()}));
    ASSERT_TRUE(program.wait_until([&] { return workers_in(folder) == 3; }, kSoon)) << moment;
    killed.signal(SIGKILL);
    const Ending ending = program.wait(kSoon);
    expect_done(folder, ending);
    EXPECT_EQ(count(ending.output, "closed its connection"), 1u) << ending.output;
    EXPECT_EQ(other.wait(kSoon).code, 0);
    EXPECT_EQ(killed.wait(kSoon).code, 128 + SIGKILL);
}

TEST(Join, WhoeverMayNotIsToldWhatToDoAndDisturbsNobody) {
    const fs::path folder = fresh_folder("run"), copy = fresh_folder("copy") / "join";
    Program program(mpirun(2) + render_for_joiners(folder, kJoinable));
    ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, 0); }, kSoon));
    const auto refused = [](const std::vector<std::string>& options, const std::string& why) {
        const Ending ending = Program(join(options)).wait(kSoon);
        EXPECT_EQ(ending.code, 2) << ending.output;
        EXPECT_EQ(count(ending.output, "\n"), 1u) << ending.output;
        EXPECT_NE(ending.output.find(why), std::string::npos) << ending.output;
    };
    JoinTicket ticket = read_ticket(folder / kTicketFileName);
    ticket.secret[5] ^= 1;
    write_ticket(copy, ticket);
    refused({"--file", copy.string()}, "the secret of this ticket is not the run's");
    ticket = read_ticket(folder / kTicketFileName);
    ticket.run[5] ^= 1;
    write_ticket(copy, ticket);
    refused({"--file", copy.string()}, "another run uses this address");
    fs::permissions(copy, fs::perms::others_read, fs::perm_options::add);
    refused({"--file", copy.string()}, "can be read by other users");
    refused({"--file", copy.string(), folder.string()}, "is given beside a run directory");
    refused({}, "does not know which run to join");
    refused({fresh_folder("empty").string()}, "is no run directory");
    const Ending ending = program.wait(kSoon);
    expect_done(folder, ending);
    EXPECT_EQ(count(ending.output, "the secret of this ticket is not the run's"), 1u) << ending.output;
    refused({folder.string()}, "is over");
}

/// Connections that say nothing, opened anew as they are closed, under a low limit of descriptors.
TEST(Join, ACrowdOfStrangersKeepsNobodyOutAndTakesNoDescriptorOfTheFiles) {
    const fs::path folder = fresh_folder("run");
    std::vector<std::string> command =
        mpirun(2) + std::vector<std::string>{"sh", "-c", "ulimit -n 40; exec \"$@\"", "sh"};
    Program program(command + render_for_joiners(folder, kJoinable));
    ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, 0); }, kSoon));
    const JoinTicket ticket = read_ticket(folder / kTicketFileName);
    std::atomic<bool> over = false;
    std::thread strangers([&] {
        std::deque<Socket> crowd;
        for (int k = 0; k < 20'000 && !over; ++k) {
            try {
                crowd.push_back(connect_to(ticket.address, ticket.port, 1));
            } catch (const RunError&) {  // the render has ended
            }
            if (crowd.size() > 100) crowd.pop_front();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
    Program guest(join({folder.string(), "--wait", "30"}));
    EXPECT_TRUE(program.wait_until([&] { return workers_in(folder) == 2; }, kSoon));
    expect_done(folder, program.wait(kSoon));
    over = true;
    strangers.join();
    const Ending ending = guest.wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
}

TEST(Join, AGuestThatIsToldToLeaveGivesBackWhatItHas) {
    const fs::path folder = fresh_folder("run");
    Program program(render_for_joiners(folder, kJoinable));
    ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, 0); }, kSoon));
    Program two(join({"-n", "2", folder.string()}));
    ASSERT_TRUE(program.wait_until([&] { return workers_in(folder) == 3; }, kSoon));
    two.signal(SIGTERM);
    const Ending left = two.wait(kSoon);
    EXPECT_EQ(left.code, 0) << left.output;
    EXPECT_EQ(count(left.output, "left the render, as it was told"), 2u) << left.output;
    const Ending ending = program.wait(kSoon);
    expect_done(folder, ending);
    EXPECT_EQ(count(ending.output, "leaves, as it was told"), 2u) << ending.output;
    EXPECT_EQ(ending.output.find("closed its connection"), std::string::npos) << ending.output;
}

TEST(Join, AGuestComesBackToARenderThatWasStartedAgain) {
    const fs::path folder = fresh_folder("run");
    const std::vector<std::string> command =
        render_for_joiners(folder, kJoinable + std::vector<std::string>{"--resume"});
    auto first = std::make_unique<Program>(command);
    Program guest(join({folder.string(), "--wait", "30"}));  // before there is anything to join
    ASSERT_TRUE(first->wait_until([&] { return workers_in(folder) == 2 && passes_done(folder) >= 1; }, kSoon));
    first->signal(SIGKILL);
    first->wait(kSoon);
    Program second(command);
    EXPECT_TRUE(second.wait_until([&] { return workers_in(folder) == 2; }, kSoon));
    expect_done(folder, second.wait(kSoon));
    const Ending ending = guest.wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(count(ending.output, "joined the render at"), 2u) << ending.output;
    EXPECT_NE(ending.output.find("the render is over"), std::string::npos) << ending.output;
}

TEST(Join, WhereNobodyCanListenNothingIsRendered) {
    for (const auto& [set, why] : {std::pair("farm.join_address=192.0.2.1", "farm.join_address: "),
                                   std::pair("farm.join_address=nowhere.invalid", "farm.join_address: ")}) {
        const fs::path folder = fresh_folder("run");
        const Ending ending =
            Program(mpirun(2) + render_for_joiners(folder, kJoinable + std::vector<std::string>{"--set", set}))
                .wait(kSoon);
        EXPECT_EQ(ending.code, 2) << ending.output;
        EXPECT_NE(ending.output.find(why), std::string::npos) << ending.output;
        EXPECT_EQ(passes_done(folder), 0);
    }
}

TEST(Join, AGuestOfARenderThatIsKilledLeaves) {
    const fs::path folder = fresh_folder("run");
    Program program(render_for_joiners(folder, kJoinable, "100000000"));
    ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, 0); }, kSoon));
    Program guest(join({folder.string(), "--wait", "1"}));
    ASSERT_TRUE(program.wait_until([&] { return workers_in(folder) == 2; }, kSoon));
    program.signal(SIGKILL);
    const Ending ending = guest.wait(kSoon);
    EXPECT_EQ(ending.code, 1) << ending.output;
    EXPECT_NE(ending.output.find("closed the connection"), std::string::npos) << ending.output;
    EXPECT_NE(ending.output.find("waiting 1 s for the render to come back"), std::string::npos) << ending.output;
    const Ending late = Program(join({folder.string()})).wait(kSoon);
    EXPECT_EQ(late.code, 2) << late.output;
    EXPECT_NE(late.output.find("nobody answers"), std::string::npos) << late.output;
}

/// A guest whose connection is lost before the render tells it to leave.
TEST(Join, AGuestThatWaitsLeavesWhenTheRenderIsOver) {
    const fs::path folder = fresh_folder("run");
    Program program(render_for_joiners(folder, kJoinable, "100000000"));
    ASSERT_TRUE(program.wait_until([&] { return has_come_to(folder, 0); }, kSoon));
    Program guest(join({folder.string(), "--wait", "6000"}));
    ASSERT_TRUE(program.wait_until([&] { return workers_in(folder) == 2; }, kSoon));
    program.signal(SIGKILL);
    program.wait(kSoon);
    std::ofstream(folder / "status.json") << R"({"state": "done"})";
    const Ending ending = guest.wait(kSoon);
    EXPECT_FALSE(ending.timed_out);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_NE(ending.output.find("the render is over"), std::string::npos) << ending.output;
}

}  // namespace
}  // namespace treefarm::test
