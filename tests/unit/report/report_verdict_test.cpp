// SPDX-License-Identifier: Apache-2.0
// What a report answers: who won, whether chance can have made it, what 5 % costs; from results made up here.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/base/error.h"
#include "report/figure_export.h"
#include "report/figure_text.h"
#include "report/gain.h"
#include "report/processor_fraction.h"
#include "report/run_results.h"
#include "report/study_charts.h"
#include "report/study_page.h"
#include "report/study_tables.h"
#include "report/verdict.h"
#include "tests/support/made_study.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

using namespace test;  // cells and studies made up

TEST(Verdict, SaysWhoWonByHowMuchAndWhatFivePercentCost) {
    const StudyResults results = study(seeds("room", 5, 0.08, 0.04));
    const std::vector<std::string> lines = answers(results, clocks()[0]);
    ASSERT_EQ(lines.size(), 1u);
    expect_part(lines[0], "room: guided won: 4.");
    expect_part(lines[0], "times as fast as plain (to equal RMSE / mean, in seconds; 5 seeds)");
    expect_part(lines[0], "5 % error took guided 2.4");
    expect_part(lines[0], "plain came down to 8.13 % error in 4 s, not to 5 %");
    expect_part(answers(results, clocks()[1])[0], "in core-seconds");
}

TEST(Verdict, TwoSeedsCannotTell) {
    const std::string text = answers(study(seeds("room", 2, 0.08, 0.04)), clocks()[0])[0];
    expect_part(text, "Cannot tell who won: 2 seeds say nothing of chance");
    expect_no_part(text, "[");
    const StudyResults results = study(seeds("room", 2, 0.08, 0.04));
    expect_no_part(headline_table(results, kRoom, clocks()[0]) + time_table(results, kRoom, measures()[0], clocks()[0]),
                   "[");
}

TEST(Verdict, IntervalsThatHoldOneCannotTell) {
    std::vector<CellResult> cells;
    for (std::size_t k = 0; k < 4; ++k) {
        cells.push_back(cell("room", "plain", k, 0.05));
        cells.push_back(cell("room", "guided", k, k % 2 == 0 ? 0.04 : 0.06));
    }
    const StudyResults results = study(std::move(cells));
    expect_part(answers(results, clocks()[0])[0], "Cannot tell who won: guided came out first, ");
    expect_part(headline_table(results, kRoom, clocks()[0]), "(cannot tell)");
}

TEST(Verdict, TheBaselineMayWin) {
    expect_part(answers(study(seeds("room", 3, 0.04, 0.08)), clocks()[0])[0], "room: plain won: ");
}

TEST(Verdict, NamesMeasuresThatContradict) {
    std::vector<CellResult> cells;
    for (std::size_t k = 0; k < 3; ++k) {
        const double scatter = 1 + 0.01 * static_cast<double>(k);
        cells.push_back(cell("room", "plain", k, 0.08 * scatter, 1, 0.1));
        cells.push_back(cell("room", "guided", k, 0.04, 1, 0.3 * scatter));
    }
    expect_part(answers(study(std::move(cells)), clocks()[0])[0], "But by root of relMSE plain is better than it");
}

TEST(Verdict, JudgesScenesTogether) {
    std::vector<CellResult> cells = seeds("room", 4, 0.08, 0.04), more = seeds("hall", 4, 0.04, 0.08);
    cells.insert(cells.end(), more.begin(), more.end());
    const StudyResults results = study(std::move(cells), {kRoom, kHall});
    const std::vector<std::string> lines = answers(results, clocks()[0]);
    ASSERT_EQ(lines.size(), 3u);
    expect_part(lines[0], "All scenes: ");
    const Interval both = gain(results, results.scenes, "guided", "plain", measures()[0], clocks()[0]);
    EXPECT_EQ(both.values, 4u) << "a value per seed";
    EXPECT_NEAR(both.mean, std::pow(1.02, 2), 0.05) << "four times as fast here, a quarter there";
    expect_part(lines[1], "room: guided won");
    expect_part(lines[2], "hall: plain won");
}

TEST(Verdict, ABusyMachineIsTold) {
    // Plain had the processors, guided half of them: by seconds they are equal, by core-seconds they are not.
    std::vector<CellResult> cells;
    for (std::size_t k = 0; k < 3; ++k) {
        const double scatter = 1 + 0.01 * static_cast<double>(k);
        cells.push_back(cell("room", "plain", k, 0.05 * scatter, 0.95));
        cells.push_back(cell("room", "guided", k, 0.05, 0.5));
    }
    const StudyResults results = study(std::move(cells));
    EXPECT_NEAR(processor_fraction(results.cells[1]), 0.5, 1e-9);
    expect_part(busy_warning(results), "in 3 of 6 renders workers had less than 80 %");
    expect_part(busy_warning(results), "least: 50 %, room, guided");
    EXPECT_EQ(&main_clock(results), &clocks()[1]);
    const Interval by_cores = gain(results, {&kRoom, 1}, "guided", "plain", measures()[0], clocks()[1]);
    EXPECT_NEAR(by_cores.mean, 1.9 * 1.02, 0.01);
    EXPECT_EQ(busy_warning(study(seeds("room", 3, 0.1, 0.1, 0.9))), "");
    EXPECT_EQ(&main_clock(study(seeds("room", 3, 0.1, 0.1, 0.9))), &clocks()[0]);
}

TEST(Figures, WideIntervalsAreNotPrinted) {
    EXPECT_EQ(gain_text({2, 1.5, 2.5, 3}), "2 [1.5, 2.5]");
    EXPECT_EQ(gain_text({2, 0.5, 4, 3}), "2 [0.5, 4] (cannot tell)");
    EXPECT_EQ(gain_text({1.36, 1.003, 1.85, 3}), "1.36 [1.003, 1.85]") << "1 is not within";
    EXPECT_EQ(gain_text({2, 0.01, 215, 3}), "2 (cannot tell)");
    EXPECT_EQ(gain_text({2, 0.9, 4, 2}), "2 (2 seeds: cannot tell)");
    EXPECT_EQ(time_text(Interval{3, 2, 4, 3}, false), "3 s [2 s, 4 s]");
    EXPECT_EQ(time_text(Interval{8000, 3.78, 2e7, 3}, false), "2:13:20");
    EXPECT_EQ(time_text(100, false), "1:40");
    EXPECT_EQ(time_text(3, true), "3 s of a core");
}

TEST(Charts, ShowWhatWasMeasuredNotTheirIntervals) {
    const Picture two = convergence_chart(study(seeds("room", 2, 0.08, 0.04)), kRoom, measures()[0], clocks()[0]);
    expect_part(two.script, "set yrange [3.13");  // 3.92 % is the least error, a quarter less the axis
    expect_part(two.script, "set key below");
    const std::string svg = draw_svg(two);
    expect_part(svg, "role=\"img\"");
    expect_part(svg, "<title id=\"room_rmse_over_mean_over_seconds_seconds___4-title\">room: RMSE / mean over seconds");
    expect_part(svg, "guided ends at 3.96 %");
    expect_no_part(svg, "GNUPLOT");
    expect_no_part(svg, "<title>");
}

/// A run directory with what a report reads of it.
std::filesystem::path run_folder(const std::string& name, const std::string& type, int seed, double error,
                                 int spp = 4) {
    const auto folder = test::test_folder() / name;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "job.toml") << "[guiding]\ntype = '" << type << "'\n\n[sampler]\nseed = " << seed
                                       << "\n\n[budget]\nspp = " << spp << "\n";
    std::ofstream(folder / "summary.json")
        << R"({"scene": "/a/room.xml", "width": 8, "height": 6, "build": {"source": "abc"}, "host": "node7",
               "farm": {"workers": [{"threads": 2}, {"threads": 2}]}, "passes": [)"
        << R"({"pass": 0, "spp": 1, "spp_done": 1, "run_seconds": 1, "core_seconds": 3, "image_error": null,
               "nonzero_share": 1, "tree_nodes": 1, "tree_memory": 1, "phase_seconds": {"collect": 1}},)"
        << R"({"pass": 1, "spp": 3, "spp_done": 4, "run_seconds": 4, "core_seconds": 9, "image_error": {"relative": )"
        << error << R"(, "low": null, "high": null}, "nonzero_share": 1, "tree_nodes": 1, "tree_memory": 1,
               "phase_seconds": {"collect": 3}}]})";
    return folder;
}

TEST(Verdict, EachBudgetHasItsOwn) {
    std::vector<CellResult> cells = seeds("room", 3, 0.08, 0.04), more = seeds("room", 3, 0.02, 0.03);
    for (CellResult& one : more)
        one.budget = "seconds = 16";
    cells.insert(cells.end(), more.begin(), more.end());
    StudyResults results = study(std::move(cells));
    results.budgets = {"seconds = 4", "seconds = 16"};
    const std::vector<std::string> lines = answers(results, clocks()[0]);
    ASSERT_EQ(lines.size(), 2u);
    expect_part(lines[0], "room, seconds = 4: guided won");
    expect_part(lines[1], "room, seconds = 16: plain won");
    expect_part(budget_table(results, kRoom, clocks()[0]), "<th>seconds = 4</th><th>seconds = 16</th>");
}

TEST(Tables, EndWithTheFirstAccuracyThatNobodyReached) {
    const std::string html = time_table(study(seeds("room", 3, 0.08, 0.04)), kRoom, measures()[0], clocks()[0]);
    expect_part(html, "<th>to 5 %</th><th>to 2 %</th></tr>");
}

TEST(Runs, MakeAStudyWithoutReferences) {
    const std::vector<std::filesystem::path> folders = {
        run_folder("a", "none", 1, 0.08), run_folder("b", "ppg", 1, 0.04),   run_folder("c", "none", 2, 0.081),
        run_folder("d", "ppg", 2, 0.041), run_folder("e", "none", 3, 0.082), run_folder("f", "ppg", 3, 0.041)};
    const StudyResults results = read_run_results(folders);
    ASSERT_EQ(results.methods.size(), 2u);
    EXPECT_EQ(results.baseline, "type = none");
    EXPECT_EQ(results.of("room 8 x 6", "type = ppg").size(), 3u) << "seeds are repetitions";
    EXPECT_EQ(results.cells[0].passes.back().core_seconds, 12) << "since the render began";
    EXPECT_EQ(results.cells[0].made.threads, 4);
    expect_part(answers(results, clocks()[0])[0],
                "room 8 x 6: type = ppg won: 3.97 [3.83, 4.11] times as fast as type = none (to equal estimated RMSE");
    expect_part(study_page(results), "No reference: errors are those that the renders estimated");
    const std::vector<std::filesystem::path> alike = {folders[0], folders[2]};
    expect_part(answers(read_run_results(alike), clocks()[0])[0],
                "There is one method only, and nothing to compare it with: " + folders[0].string() + " and " +
                    folders[2].string() + " differ by seed or image size alone.");
    const std::vector<std::filesystem::path> twice = {folders[0], run_folder("again", "none", 1, 0.08)};
    EXPECT_EQ(read_run_results(twice).methods.size(), 2u) << "the same render twice is no second seed";
    std::filesystem::remove(folders[0] / "summary.json");
    EXPECT_THROW(read_run_results(folders), InputError);
}

TEST(Runs, OfUnequalBudgetsAreMethodsOfTheirOwn) {
    const std::vector<std::filesystem::path> folders = {run_folder("few", "ppg", 1, 0.08, 4),
                                                        run_folder("many", "ppg", 2, 0.03, 64)};
    const StudyResults results = read_run_results(folders);
    ASSERT_EQ(results.methods.size(), 2u);
    EXPECT_EQ(results.methods[1].name, "spp = 64");
    expect_part(answers(results, clocks()[0])[0], "spp = 64 came out first, ");
}

TEST(Export, WritesFiguresForAPaper) {
    const auto folder = test::fresh_test_folder();
    const ExportedFigures exported =
        export_figures(study(seeds("room", 3, 0.08, 0.04)), {figure_width("84mm"), "Times", 8}, folder);
    EXPECT_EQ(exported.figures, 7) << "three measures by two clocks, and the estimates";
    const auto text = [&](const std::string& name) {
        std::ifstream file(folder / name, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string name = "room_rmse_over_mean_over_seconds_seconds___4";
    expect_part(text(name + ".svg"), "width=\"317\"");  // 84 mm at 96 dots per inch
    expect_part(text(name + ".svg"), "Times");
    expect_part(text(name + ".csv"), "pass,plain,1,1,0.16,,\n");
    EXPECT_TRUE(!exported.with_pdf || text(name + ".pdf").starts_with("%PDF"));
    EXPECT_THROW(figure_width("wide"), InputError);
    EXPECT_THROW(figure_width("3.3 feet"), InputError);
    EXPECT_THROW(figure_width("0in"), InputError);
    std::filesystem::remove_all(folder);
}

TEST(Page, BeginsWithItsAnswer) {
    StudyResults results = study(seeds("room", 3, 0.08, 0.04, 0.5));
    results.has_references = false;
    results.folder = "/tmp/nowhere";
    for (CellResult& one : results.cells)
        one.made = {"abc123", "node7", "A Processor", "2026-11-25 21:22", 2, 2};
    const std::string html = study_page(results);
    for (const char* part : {"name=\"viewport\"", "<b>room</b>: guided won", "Beside a busy processor",
                             "by treefarm abc123 on node7 (A Processor) at 2026-11-25 21:22 UTC, by 2 workers",
                             "id=\"by-core_seconds\" class=\"clock\" autocomplete=\"off\" checked"})
        expect_part(html, part);
    EXPECT_LT(html.find("guided won"), html.find("<table>"));
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

TEST(Page, ShowsOneMeasureAndFoldsTheOthers) {
    StudyResults results = study(seeds("room", 3, 0.08, 0.04));
    results.has_references = false;
    results.folder = "/tmp/nowhere";
    const std::string html = study_page(results), open = html.substr(0, html.find("<details>"));
    ASSERT_LT(open.size(), html.size());
    EXPECT_EQ(count(open, "<svg"), 2u) << "one chart, by each clock";
    expect_part(open, "<th>error</th><th>times as fast as plain</th>");
    for (const char* unknown : {"relMSE", "gain"})
        expect_no_part(open.substr(open.find("<h2>")), unknown);
    expect_part(html, "<summary>Other measures</summary>");
    EXPECT_EQ(count(html, "<details>"), count(html, "</details>"));
}

TEST(Measures, ThatAreEqualAreLeftOut) {
    const StudyResults results = study(seeds("room", 3, 0.08, 0.04));
    EXPECT_EQ(distinct_measures(results.cells).size(), 1u) << "made up so that all are equal";
    std::vector<CellResult> cells = seeds("room", 2, 0.08, 0.04);
    for (CellResult& cell : cells)
        for (PassRow& row : cell.passes)
            row.measured["rel_mse"] = row.measured["rel_mse_trimmed"] = 0.3;
    ASSERT_EQ(distinct_measures(cells).size(), 2u);
    EXPECT_STREQ(distinct_measures(cells)[1].key, "root_rel_mse");
    cells.back().passes.back().measured["rel_mse_trimmed"] = 0.2;
    EXPECT_EQ(distinct_measures(cells).size(), 3u);
}

}  // namespace
}  // namespace treefarm
