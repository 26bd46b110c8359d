// SPDX-License-Identifier: Apache-2.0
// The line that says how far something is: its width, its fields, when it is said.
#include "common/base/status.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/log.h"
#include "coordinator/words/reading_notice.h"

namespace treefarm {
namespace {

Status halfway() {
    Status status;
    status.fraction = 0.5;
    status.fields = {"50 % of 127 spp", "about 6 s left", "pass 6/7", "", "error 42.8 %"};
    return status;
}

TEST(Status, FitsWhateverTheWidth) {
    for (int columns = 0; columns <= 200; ++columns)
        EXPECT_LE(text_columns(status_text(halfway(), columns)), columns);
}

TEST(Status, LosesFieldsFromTheRightAndThenItsBar) {
    EXPECT_EQ(status_text(halfway(), 120),
              "[===============               ]  50 % of 127 spp   about 6 s left   pass 6/7   error 42.8 %");
    EXPECT_EQ(status_text(halfway(), 72), "[=====     ]  50 % of 127 spp   about 6 s left   pass 6/7   error 42.8 %");
    EXPECT_EQ(status_text(halfway(), 71), "[============            ]  50 % of 127 spp   about 6 s left   pass 6/7");
    EXPECT_EQ(status_text(halfway(), 40), "[==  ]  50 % of 127 spp   about 6 s left");
    EXPECT_EQ(status_text(halfway(), 39), "50 % of 127 spp   about 6 s left");
    EXPECT_EQ(status_text(halfway(), 31), "[======      ]  50 % of 127 spp");
    EXPECT_EQ(status_text(halfway(), 7), "50 % of");
}

TEST(Status, HasNoBarWhereNobodyKnows) {
    Status status = halfway();
    status.fraction = -1;
    EXPECT_EQ(status_text(status, 60), "50 % of 127 spp   about 6 s left   pass 6/7   error 42.8 %");
}

TEST(Status, CutsBetweenCharacters) {
    EXPECT_EQ(text_columns("K\xc3\xbc"
                           "che"),
              5);
    EXPECT_EQ(cut_to_columns("K\xc3\xbc"
                             "che",
                             2),
              "K\xc3\xbc");
    EXPECT_EQ(text_columns("\xe6\x9c\xa8"), 2) << "a wide character";
    EXPECT_EQ(cut_to_columns("\xe6\x9c\xa8\xe6\x9c\xa8", 3), "\xe6\x9c\xa8");
    EXPECT_EQ(cut_to_columns("\xc3", 1), "\xc3") << "not UTF-8: a byte is a column";
}

TEST(Status, TheFirstLineComesAfterAWhileAndThenNotOften) {
    StatusPace pace(10, 10);
    int said = 0;
    for (int tenth = 0; tenth < 99; ++tenth)
        said += pace.due(0.1 * tenth);
    EXPECT_EQ(said, 0) << "a short render";
    for (int tenth = 99; tenth <= 351; ++tenth)
        said += pace.due(0.1 * tenth);
    EXPECT_EQ(said, 3);
}

/// A console, and what it writes into a pipe.
class Written {
  public:
    explicit Written(TerminalKind kind, bool shows_status = true) {
        EXPECT_EQ(pipe(ends_), 0);
        console = std::make_shared<Console>(kind, shows_status, ends_[1]);
    }
    ~Written() {
        close(ends_[0]);
        close(ends_[1]);
    }
    /// Waits for something, if nothing was written.
    std::string text() const {
        char bytes[4096];
        const ssize_t count = read(ends_[0], bytes, sizeof bytes);
        return std::string(bytes, count > 0 ? static_cast<std::size_t>(count) : 0);
    }

    ConsolePtr console;

  private:
    int ends_[2] = {-1, -1};
};

TEST(Console, LinesStandAboveTheStatus) {
    const Written written({true, false});
    written.console->status(halfway());
    written.console->line("a worker is lost");
    written.console->end_status();
    const std::string status = status_text(halfway(), 79);
    EXPECT_EQ(written.text(),
              "\r" + status + "\x1b[K" + "\r\x1b[K" + "a worker is lost\n" + "\r" + status + "\x1b[K" + "\r\x1b[K");
}

TEST(Console, WithoutATerminalNothingIsDrawn) {
    const Written written({});
    for (int k = 0; k < 100; ++k)
        written.console->status(halfway());
    written.console->line("done");
    EXPECT_EQ(written.text(), "done\n");
}

TEST(ReadingNotice, SpeaksWhenItTakesLong) {
    const Written written({true, false});
    {
        const ReadingNotice notice(written.console, "kitchen");
        EXPECT_EQ(written.text(), "\rreading kitchen   1 s so far\x1b[K");
    }
    EXPECT_EQ(written.text(), "\r\x1b[K") << "wiped when it is read";
    EXPECT_EQ(reading_status("kitchen", 12.2).line, "reading kitchen   12 s so far");
}

TEST(Log, PlainInformationStandsAlone) {
    const Written plain({}), coloured({true, true}, false);
    for (const Written* written : {&plain, &coloured}) {
        const Log log = make_log("treefarm", {}, written->console, Verbosity::normal);
        log->debug("every figure");
        log->info("pass 1");
        log->warn("name with\x1b[2J controls\n");
        log->error("no");
    }
    EXPECT_EQ(plain.text(), "pass 1\ntreefarm: warning: name with?[2J controls?\ntreefarm: error: no\n");
    EXPECT_EQ(
        coloured.text(),
        "pass 1\ntreefarm: \x1b[1;33mwarning\x1b[m: name with?[2J controls?\ntreefarm: \x1b[1;31merror\x1b[m: no\n");
}

TEST(Log, VerbositySaysWhatIsLeftOut) {
    const Written quiet({}), verbose({});
    for (const auto& [written, verbosity] :
         {std::pair(&quiet, Verbosity::quiet), std::pair(&verbose, Verbosity::verbose)}) {
        const Log log = make_log("treefarm", {}, written->console, verbosity);
        log->debug("every figure");
        log->warn("careful");
        log->error("no");
    }
    EXPECT_EQ(quiet.text(), "treefarm: error: no\n");
    EXPECT_EQ(verbose.text(), "every figure\ntreefarm: warning: careful\ntreefarm: error: no\n");
}

}  // namespace
}  // namespace treefarm
