// SPDX-License-Identifier: Apache-2.0
#include "common/base/log.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <future>
#include <thread>

#include "common/base/text/printable.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

ConsolePtr silent() {
    return std::make_shared<Console>(TerminalKind{}, false);
}

TEST(Printable, KeepsTextAndReplacesWhatSteersTerminals) {
    EXPECT_EQ(printable("plain, caf\u00e9, \u4e2d\u6587, \U0001f600"), "plain, caf\u00e9, \u4e2d\u6587, \U0001f600");
    EXPECT_EQ(printable("a\nb\rc\td\x1b[31m\x7f"), "a?b?c?d?[31m?");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "?31m")
        << "C1's CSI";
    EXPECT_EQ(printable("\xff\xe9z"), "??z") << "Latin-1";
    EXPECT_EQ(printable("\xc1\xbf \xe0\x80\xaf"), "?? ???") << "longer forms than needed";
    EXPECT_EQ(printable("\xe4\xb8"), "??") << "cut short";
    EXPECT_EQ(printable("\u202egpj.exe"), "?gpj.exe") << "turns the direction of writing";
}

TEST(Log, ALineIsALine) {
    const fs::path file = fs::path(testing::TempDir()) / "log_test.txt";
    fs::remove(file);
    Log log = make_log("treefarm", file, silent(), Verbosity::quiet);
    log->info("results in {}", "runs/a\n2026-01-01 treefarm error: forged\x1b[2J");
    log.reset();  // all is written then
    const std::string text = test::read_file(file);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_NE(text.find("treefarm info: results in runs/a?2026"), std::string::npos) << text;
}

TEST(Log, GoesOnInAFileThatWasRemoved) {
    const fs::path folder = fs::path(testing::TempDir()) / "log_test_folder", file = folder / "log.txt";
    fs::create_directories(folder);
    Log log = make_log("treefarm", file, silent(), Verbosity::quiet);
    log->info("one");
    while (test::read_file(file).find("one") == std::string::npos)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    fs::remove_all(folder);
    log->info("nowhere");
    fs::create_directories(folder);
    log->info("two");
    log.reset();
    EXPECT_NE(test::read_file(file).find("two"), std::string::npos);
}

/// A pipe that nobody reads is such a disk: to open it takes as long as it takes a reader to come.
TEST(Log, DoesNotWaitForADiskThatHangs) {
    const fs::path pipe = fs::path(testing::TempDir()) / "log_test_pipe";
    fs::remove(pipe);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::signal(SIGPIPE, SIG_IGN);  // as the program does: a reader may have left
    Log log = make_log("treefarm", pipe, silent(), Verbosity::quiet);
    std::future<void> said = std::async(std::launch::async, [&] {
        for (int i = 0; i < 10000; ++i)
            log->info("line {}", i);
    });
    const bool waited = said.wait_for(std::chrono::seconds(20)) != std::future_status::ready;
    EXPECT_FALSE(waited);
    std::string last;
    std::thread reader([&] {
        // Each line opens the pipe anew.
        while (last.find("line 9999") == std::string::npos)
            last = test::read_file(pipe);
    });
    said.wait();
    log.reset();
    reader.join();
    EXPECT_NE(last.find("line 9999"), std::string::npos) << "the newest lines are kept";
}

}  // namespace
}  // namespace treefarm
