// SPDX-License-Identifier: Apache-2.0
// Budgets that look at clock or error, and their schedules, through the program.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/mpi/program.h"
#include "tests/support/support.h"

namespace treefarm::test {
namespace {

std::vector<std::string> render_within(const std::filesystem::path& folder, const std::vector<std::string>& options) {
    return std::vector<std::string>{TREEFARM_PROGRAM,
                                    "render",
                                    own_scene("cornell-box.xml"),
                                    "-D",
                                    "size=48",
                                    "--threads",
                                    "1",
                                    "--set",
                                    "guiding.spatial_threshold=500",
                                    "--run-dir",
                                    folder.string()} +
           options;
}

nlohmann::json run(const std::vector<std::string>& launcher, const std::vector<std::string>& options, int code = 0) {
    const auto folder = fresh_folder("budget");
    const Ending ending = Program(launcher + render_within(folder, options)).wait(kSoon);
    EXPECT_EQ(ending.code, code) << ending.output;
    nlohmann::json summary = read_summary(folder);
    summary["folder"] = folder.string();
    return summary;
}

std::string schedule_of(const nlohmann::json& summary) {
    return summary["folder"].get<std::string>() + "/schedule.toml";
}

void expect_replays(const nlohmann::json& summary, const std::vector<std::string>& options) {
    ASSERT_GE(summary["passes"].size(), 3u) << "the test must exercise the tree";
    for (const int ranks : {0, 2, 4}) {
        const auto launcher = ranks == 0 ? std::vector<std::string>() : mpirun(ranks);
        const nlohmann::json again =
            run(launcher, std::vector<std::string>{"--schedule", schedule_of(summary)} + options);
        EXPECT_EQ(again["image_hash"], summary["image_hash"]) << ranks << " ranks";
        EXPECT_EQ(again["tree_hash"], summary["tree_hash"]) << ranks << " ranks";
        EXPECT_EQ(again["passes"].size(), summary["passes"].size());
    }
}

TEST(Schedule, OfSecondsReplays) {
    expect_replays(run(mpirun(3), {"--seconds", "2"}), {});
}

TEST(Schedule, OfPassesOfOneTreeReplays) {
    const std::vector<std::string> last = {"--set", "guiding.combination=last"};
    expect_replays(run({}, std::vector<std::string>{"--seconds", "2"} + last), last);
}

TEST(Schedule, OfAnErrorReplays) {
    const std::vector<std::string> strict = {"--set", "budget.strict=true"};
    expect_replays(run({}, {"--error", "0.5"}), {});
    expect_replays(run({}, std::vector<std::string>{"--error", "0.5"} + strict), strict);
}

TEST(Schedule, ThatIsMalformedSaysWhere) {
    const auto folder = fresh_folder("schedule");
    const std::string file = (folder / "bad.toml").string();
    std::ofstream(file) << "[[pass]]\nspp = many\n";
    const Ending ending = Program(render_within(folder / "run", {"--schedule", file})).wait(kSoon);
    EXPECT_EQ(ending.code, 2);
    EXPECT_NE(ending.output.find("bad.toml:2:7: "), std::string::npos) << ending.output;
}

TEST(OpenBudget, OfNoTimeRendersOnePass) {
    for (const int ranks : {0, 3}) {
        const nlohmann::json summary =
            run(ranks == 0 ? std::vector<std::string>() : mpirun(ranks), {"--seconds", "0.001"});
        EXPECT_EQ(summary["state"], "done");
        EXPECT_EQ(summary["spp"], 1);
        EXPECT_TRUE(summary["image_error"].is_null()) << "one sample says nothing of its error";
    }
}

TEST(OpenBudget, AnErrorOutOfReachKeepsTheImageAndSaysSo) {
    const nlohmann::json summary = run({}, {"--error", "0.01", "--set", "budget.max_spp=20"}, 4);
    EXPECT_EQ(summary["state"], "done");
    EXPECT_EQ(summary["spp"], 20);
    EXPECT_EQ(summary["target"]["reached"], false);
    EXPECT_TRUE(std::filesystem::exists(summary["folder"].get<std::string>() + "/image.exr"));
    const nlohmann::json within = run({}, {"--error", "0.5"});
    EXPECT_EQ(within["target"]["reached"], true);
    EXPECT_LE(within["image_error"]["relative"], 0.5);
}

}  // namespace
}  // namespace treefarm::test
