// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "tests/mpi/program.h"
#include "tests/mpi/screen.h"
#include "tests/mpi/terminal_program.h"
#include "tests/support/support.h"

// What a person sees who looks on.

namespace treefarm::test {
namespace {

const std::vector<std::string> kTerminal = {"TERM=xterm", "NO_COLOR"};

std::vector<std::string> shown_render(const std::vector<std::string>& options) {
    return std::vector<std::string>{TREEFARM_PROGRAM,
                                    "render",
                                    own_scene("cornell-box.xml"),
                                    "-D",
                                    "size=64",
                                    "--threads",
                                    "1",
                                    "--run-dir",
                                    (fresh_folder("run") / "r").string()} +
           options;
}

/// A program's output, as bytes and on a screen.
struct Shown {
    int code = -1;
    std::string bytes;
    int most_bars = 0;  ///< rows that held a piece of the line that is drawn again, at a time
    Screen screen{80};

    std::size_t redraws() const { return count(bytes, "\x1b[K"); }
};

Shown watch(const std::vector<std::string>& arguments, int columns,
            const std::vector<std::string>& environment = kTerminal,
            const std::function<void(TerminalProgram&, Shown&)>& meanwhile = {}) {
    Shown shown;
    shown.screen = Screen(columns > 0 ? columns : 80);
    TerminalProgram program(arguments, columns, environment);
    shown.code = program.follow([&](const std::string& bytes) {
        shown.bytes += bytes;
        shown.screen.feed(bytes);
        shown.most_bars = std::max(shown.most_bars, shown.screen.rows_with(" % of "));
        if (meanwhile) meanwhile(program, shown);
    });
    return shown;
}

TEST(Terminal, ProgressIsOneLineWhateverTheWidth) {
    for (const int columns : {80, 60, 40, 12, 0}) {
        const Shown shown = watch(shown_render({"--seconds", "2"}), columns);
        EXPECT_EQ(shown.code, 0);
        EXPECT_GE(shown.redraws(), 5u) << shown.screen.text();
        EXPECT_LE(shown.most_bars, 1) << columns << " columns:\n" << shown.screen.text();
        EXPECT_EQ(shown.screen.rows_with(" % of "), 0) << "it is wiped at the end\n" << shown.screen.text();
        EXPECT_GE(shown.screen.rows_with("error "), 1) << shown.screen.text();
    }
}

TEST(Terminal, ProgressFollowsANewWidth) {
    bool resized = false;
    const Shown shown =
        watch(shown_render({"--seconds", "3"}), 80, kTerminal, [&](TerminalProgram& program, Shown& so_far) {
            if (resized || so_far.redraws() < 5) return;
            resized = true;
            program.resize(50);
            so_far.screen.resize(50);
        });
    ASSERT_TRUE(resized);
    EXPECT_EQ(shown.code, 0);
    // One that was on its way may have wrapped.
    EXPECT_LE(shown.most_bars, 2) << shown.screen.text();
}

TEST(Terminal, APassIsALineOfAtMost80Columns) {
    const Shown shown = watch(shown_render({"--spp", "127"}), 200);
    EXPECT_EQ(shown.code, 0);
    EXPECT_EQ(shown.screen.rows_with("pass "), 7) << shown.screen.text();
    EXPECT_EQ(shown.screen.rows_with("pass 7/7   127 spp   "), 1) << shown.screen.text();
    for (const std::string& row : shown.screen.rows())
        if (row.find(".xml") == row.npos && row.find("/r") == row.npos) {
            EXPECT_LE(row.size(), 80u) << row;
        }
    for (const char* word : {"stuv", "info", "Mrays"})
        EXPECT_EQ(shown.screen.rows_with(word), 0) << shown.screen.text();
}

TEST(Terminal, VerboseSaysEveryFigureThatIsKnown) {
    const Shown shown = watch(shown_render({"--spp", "7", "-v"}), 500);
    EXPECT_EQ(shown.screen.rows_with("Mrays/s"), 3) << shown.screen.text();
    EXPECT_EQ(shown.screen.rows_with("stuv "), 2) << "one sample has no variance\n" << shown.screen.text();
    EXPECT_EQ(shown.screen.rows_with("stuv 0,"), 0) << shown.screen.text();
}

TEST(Terminal, QuietSaysNothing) {
    EXPECT_EQ(watch(shown_render({"--spp", "7", "-q"}), 80).bytes, "");
}

TEST(Terminal, ColoursGoByTheEnvironment) {
    // 5 spp become more: a warning, of which one word has a colour.
    const auto warned = [] { return shown_render({"--spp", "5", "--set", "guiding.spp_unit=4"}); };
    const std::string colour = "\x1b[1;33m";
    EXPECT_EQ(count(watch(warned(), 80).bytes, colour), 1u);
    EXPECT_EQ(count(watch(warned(), 80, {"TERM=xterm", "NO_COLOR="}).bytes, colour), 1u);
    const std::string without = watch(warned(), 80, {"TERM=xterm", "NO_COLOR=1"}).bytes;
    EXPECT_EQ(count(without, "\x1b[") - count(without, "\x1b[K"), 0u) << without;
    EXPECT_EQ(count(without, "warning: "), 1u) << without;
}

TEST(Terminal, ADumbOneGetsWholeLines) {
    for (const std::vector<std::string>& environment : {std::vector<std::string>{"TERM=dumb"}, {"TERM"}}) {
        const Shown shown = watch(shown_render({"--seconds", "1.5"}), 80, environment);
        EXPECT_EQ(shown.code, 0);
        EXPECT_EQ(count(shown.bytes, "\x1b"), 0u) << shown.bytes;
        EXPECT_EQ(count(shown.bytes, "\r"), count(shown.bytes, "\r\n")) << shown.bytes;
        EXPECT_EQ(shown.screen.rows_with(" left"), 0) << "no progress in a short render\n" << shown.bytes;
    }
}

TEST(Terminal, UnderMpirunProgressIsAWholeLineNowAndThen) {
    const Ending ending = Program(mpirun(2) + shown_render({"--seconds", "12"})).wait(120);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(count(ending.output, "\x1b") + count(ending.output, "\r"), 0u) << ending.output;
    EXPECT_GE(count(ending.output, " % of 12 s   "), 1u) << ending.output;
    EXPECT_LE(count(ending.output, " % of 12 s"), 2u) << ending.output;
}

TEST(Terminal, AStudySaysWhichCell) {
    const fs::path folder = fresh_folder("study"), file = folder / "two.toml";
    std::ofstream(file) << "seeds = 1\nwarmup = 0\n[budget]\nseconds = 1\n[job]\nimage.width = 32\nimage.height = 32\n"
                        << "[scene.box]\nfile = \"" << own_scene("cornell-box.xml") << "\"\n"
                        << "[method.unguided]\nguiding.type = \"none\"\n[method.guided]\n"
                        << "[reference]\nguiding.type = \"none\"\nbudget.spp = 256\nsampler.seed = 1000\n";
    const Shown shown =
        watch({TREEFARM_PROGRAM, "study", file.string(), "--dir", (folder / "r").string(), "--threads", "1"}, 60);
    EXPECT_EQ(shown.code, 0) << shown.screen.text();
    for (const char* cell : {"cell 1/2   box.unguided.1   ", "cell 2/2   box.guided.1   "})
        EXPECT_EQ(shown.screen.rows_with(cell), 1) << shown.screen.text();
    EXPECT_GE(count(shown.bytes, "]  cell 1/2   box.unguided.1"), 1u) << shown.bytes;
    EXPECT_GE(count(shown.bytes, "]  cell 2/2   about "), 1u) << "one cell was timed\n" << shown.bytes;
    EXPECT_LE(shown.most_bars, 1) << shown.screen.text();
}

}  // namespace
}  // namespace treefarm::test
