// SPDX-License-Identifier: Apache-2.0
#include "common/base/interrupt.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>

#include <vector>

#include "common/base/files/atomic_file.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

/// Signal mask and actions are those of the process: each test restores them.
class Interrupt : public ::testing::Test {
  protected:
    Interrupt() { pthread_sigmask(SIG_BLOCK, nullptr, &before_); }
    ~Interrupt() override { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

    sigset_t before_;
};

TEST_F(Interrupt, EachSignalThatAsksForTheEndIsSeenAndKillsNothing) {
    signal(SIGHUP, SIG_DFL);  // nohup ignores it
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU}) {
        InterruptWatch watch;
        EXPECT_FALSE(watch.interrupted());
        raise(number);
        EXPECT_TRUE(watch.interrupted()) << number;
    }
}

TEST_F(Interrupt, AWorkerLeavesForSomeOfThem) {
    for (const auto& [number, leaves] : std::vector<std::pair<int, bool>>{
             {SIGTERM, true}, {SIGXCPU, true}, {SIGINT, false}, {SIGUSR1, false}, {SIGUSR2, false}}) {
        InterruptWatch watch;
        raise(number);
        EXPECT_EQ(watch.terminated(), leaves) << number;
        watch.interrupted();  // takes a signal that waits
    }
}

TEST_F(Interrupt, SignalsForAnImmediateEndKeepTheirAction) {
    const InterruptWatch watch;
    sigset_t blocked;
    pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
    for (const int number : {SIGQUIT, SIGABRT, SIGTSTP, SIGXFSZ})
        EXPECT_EQ(sigismember(&blocked, number), 0) << number;
}

TEST_F(Interrupt, BeyondTheLimitOfAFilesSizeAWriteFails) {
    const auto folder = test::fresh_test_folder();
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{1000, before.rlim_max};
    ignore_size_limits();
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    int error = 0;
    try {
        write_file_atomically(folder / "large", std::vector<std::uint8_t>(2000));
    } catch (const FileError& failure) {
        error = failure.code();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_DFL);
    EXPECT_EQ(error, EFBIG);
    EXPECT_FALSE(std::filesystem::exists(folder / "large"));
}

}  // namespace
}  // namespace treefarm
