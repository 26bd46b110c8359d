// SPDX-License-Identifier: Apache-2.0
// What treefarm launch makes of the output of mpirun and the ranks: lines for people, and signs of life.
#include "coordinator/launch/launch_output.h"

#include <gtest/gtest.h>

#include <climits>

namespace treefarm {
namespace {

LifeStatus status_of(std::uint64_t beat) {
    LifeStatus status;
    status.attempt = "ab.2";
    status.beat = beat;
    status.workers = {{"node1", false}};
    return status;
}

TEST(LaunchOutput, LinesPassWholeAndPrintable) {
    LaunchOutput output;
    EXPECT_EQ(output.take("pass 1/", true).terminal, "");
    const LaunchOutput::Lines lines = output.take("8\n\x1b[31mred\ta\r\n\nrest", true);
    EXPECT_EQ(lines.terminal, "pass 1/8\n?[31mred a\n\n");
    EXPECT_EQ(lines.log, lines.terminal);
    EXPECT_EQ(output.take_rest().terminal, "rest\n");
    EXPECT_EQ(output.take_rest().terminal, "");
    EXPECT_EQ(output.take(std::string(100000, 'x'), true).log.size(), 100001u) << "a line without end";
}

TEST(LaunchOutput, SignsOfLifeAreNoWords) {
    LaunchOutput output;
    EXPECT_FALSE(output.sign());
    const std::string line = life_line(status_of(7));
    EXPECT_EQ(output.take("before\n" + line.substr(0, 20), true).log, "before\n");
    EXPECT_EQ(output.take(line.substr(20) + "after\n", true).log, "after\n");
    ASSERT_TRUE(output.sign());
    EXPECT_EQ(output.sign()->beat, 7u);
    EXPECT_EQ(output.sign()->workers.size(), 1u);
    EXPECT_EQ(output.take("half a line" + life_line(status_of(8)), true).terminal, "half a line\n");
    EXPECT_EQ(output.sign()->beat, 8u);
    EXPECT_EQ(output.take("\x1e{nonsense\n", true).terminal, "");
    EXPECT_EQ(output.sign()->beat, 8u);
    output = {};
    EXPECT_FALSE(output.sign());
}

TEST(LaunchOutput, ASignFitsIntoAPipe) {
    LifeStatus crowd = status_of(1);
    crowd.workers.assign(1000, {"a-rather-long-name.cluster.example.org", true});
    EXPECT_LE(life_line(crowd).size(), std::size_t{PIPE_BUF});
    LaunchOutput output;
    output.take(life_line(crowd), true);
    ASSERT_TRUE(output.sign());
    EXPECT_EQ(output.sign()->attempt, "ab.2");
}

TEST(LaunchOutput, WordsOfOpenMpiAboutLossesAreForTheLogOnceTheRenderLives) {
    const std::string words =
        "[node1:12] PMIX ERROR: BAD-PARAM in file event.c at line 1033\nmpirun: Forwarding signal 10 to job\nno "
        "slots\n";
    LaunchOutput output;
    EXPECT_EQ(output.take(words, false).terminal, words) << "they may say why it does not start";
    const LaunchOutput::Lines lines = output.take(words, true);
    EXPECT_EQ(lines.terminal, "no slots\n");
    EXPECT_EQ(lines.log, words);
}

}  // namespace
}  // namespace treefarm
