// SPDX-License-Identifier: Apache-2.0
#include "common/base/log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/fanotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
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
    const fs::path file = test::fresh_test_folder() / "log.txt";
    Log log = make_log("treefarm", file, silent(), Verbosity::quiet);
    log->info("results in {}", "runs/a\n2026-01-01 treefarm error: forged\x1b[2J");
    log.reset();  // all is written then
    const std::string text = test::read_file(file);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_NE(text.find("treefarm info: results in runs/a?2026"), std::string::npos) << text;
}

TEST(Log, GoesOnInAFileThatWasRemoved) {
    const fs::path folder = test::fresh_test_folder(), file = folder / "log.txt";
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

/// A file whose opening waits for permission, which root may do, is on such a disk.
TEST(Log, DoesNotWaitForADiskThatHangs) {
    const fs::path file = test::test_folder() / "log.txt";
    std::ofstream(file).flush();
    const int permissions = fanotify_init(FAN_CLASS_CONTENT | FAN_CLOEXEC, O_RDONLY);
    if (permissions < 0 || fanotify_mark(permissions, FAN_MARK_ADD, FAN_OPEN_PERM, AT_FDCWD, file.c_str()) != 0)
        GTEST_SKIP() << "the kernel or the user may not hold up the opening of a file";
    Log log = make_log("treefarm", file, silent(), Verbosity::quiet);
    std::future<void> said = std::async(std::launch::async, [&] {
        for (int i = 0; i < 10000; ++i)
            log->info("line {}", i);
    });
    EXPECT_EQ(said.wait_for(std::chrono::seconds(20)), std::future_status::ready);
    close(permissions);  // allows all that waits
    said.wait();
    log.reset();
    EXPECT_NE(test::read_file(file).find("line 9999"), std::string::npos) << "the newest lines are kept";
}

TEST(Log, IsNotWrittenIntoAPipe) {
    const fs::path pipe = test::fresh_test_folder() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    Log log = make_log("treefarm", pipe, silent(), Verbosity::quiet);
    log->info("lost");
    log.reset();  // does not wait for a reader
    EXPECT_TRUE(fs::is_fifo(pipe));
}

}  // namespace
}  // namespace treefarm
