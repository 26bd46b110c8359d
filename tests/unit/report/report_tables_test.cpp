// SPDX-License-Identifier: Apache-2.0
// What a study's report says of effects, forecasts and benchmarks, from results made up here.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/base/error.h"
#include "report/bench_table.h"
#include "report/effect_costs.h"
#include "report/html.h"
#include "report/prediction_table.h"
#include "report/price_list.h"
#include "report/tree_pictures.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

std::filesystem::path fresh_folder(const std::string& name) {
    static int number = 0;
    const auto folder = test::test_folder() / (name + std::to_string(number++));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

PassRow pass_row(double seconds, double error, double core_seconds = 1) {
    PassRow row;
    row.run_seconds = seconds;
    row.core_seconds = core_seconds;
    row.measured = {{"rmse_over_mean", error}, {"rel_mse", error * error}, {"rel_mse_trimmed", error * error}};
    row.estimate = error;
    row.estimate_low = 0.9 * error;
    row.estimate_high = 1.1 * error;
    row.halving = row.target = {NAN, ""};
    return row;
}

CellResult table_cell(const std::string& method, std::size_t repetition, std::vector<PassRow> passes) {
    CellResult result;
    result.scene = "room";
    result.method = method;
    result.repetition = repetition;
    result.passes = std::move(passes);
    return result;
}

StudyResults study_of(std::vector<MethodResult> methods, std::vector<CellResult> cells) {
    StudyResults results;
    results.scenes = {{"room", "room.xml", "room.exr", 0.001, true}};
    results.baseline = methods.front().name;
    results.methods = std::move(methods);
    results.cells = std::move(cells);
    return results;
}

TEST(EffectCosts, AreOfMethodsThatDifferByOneSwitch) {
    const StudyResults results = study_of(
        {{"all", {{"guiding.type", "ppg"}}},
         {"no bump", {{"guiding.type", "ppg"}, {"effects.bump", "false"}}},
         {"unguided, no bump", {{"guiding.type", "none"}, {"effects.bump", "false"}}},
         {"no bump or masks", {{"guiding.type", "ppg"}, {"effects.bump", "false"}, {"effects.masks", "false"}}}},
        {table_cell("all", 0, {pass_row(1, 0.1, 3)}), table_cell("all", 1, {pass_row(1, 0.1, 6)}),
         table_cell("no bump", 0, {pass_row(1, 0.1, 2)}), table_cell("no bump", 1, {pass_row(1, 0.1, 4)}),
         table_cell("unguided, no bump", 0, {pass_row(1, 0.1, 1)}),
         table_cell("no bump or masks", 0, {pass_row(1, 0.1, 1)}),
         table_cell("no bump or masks", 1, {pass_row(1, 0.1, 2)})});
    const std::vector<EffectCost> costs = effect_costs(results, results.scenes[0]);
    ASSERT_EQ(costs.size(), 2u);
    EXPECT_EQ(costs[0].effect, "bump");
    EXPECT_EQ(costs[0].with, "all");
    EXPECT_EQ(costs[0].off, "no bump");
    EXPECT_NEAR(costs[0].core_seconds.mean, 1.5, 1e-12);
    EXPECT_NEAR(costs[0].core_seconds.low, 1.5, 1e-9) << "seeds are paired";
    EXPECT_EQ(costs[1].effect, "masks");
    EXPECT_EQ(costs[1].with, "no bump") << "what it costs where there is no bump";
    EXPECT_NEAR(costs[1].core_seconds.mean, 2, 1e-12);
}

TEST(EffectCosts, StandInThePlan) {
    StudyResults results =
        study_of({{"all", {}}, {"no bump", {{"effects.bump", "false"}}}},
                 {table_cell("all", 0, {pass_row(1, 0.1, 3)}), table_cell("no bump", 0, {pass_row(1, 0.1, 2)})});
    for (CellResult& one : results.cells) {
        one.folder = fresh_folder("plan");
        std::ofstream(one.folder / "plan.json")
            << R"({"effects": [{"name": "bump", "on": )" << (one.method == "all" ? "true" : "false")
            << R"(, "reason": "1 <material>", "bytes": 2048}, {"name": "lens", "on": false, "reason": "", "bytes": 0}]})";
    }
    const std::string html = plan_tables(results, results.scenes[0]);
    EXPECT_NE(html.find("<td>bump</td><td>yes</td><td>2 KiB</td><td>&times;1.5</td><td>1 &lt;material&gt;</td>"),
              std::string::npos)
        << html;
    EXPECT_NE(html.find("<td>bump</td><td>no</td><td></td><td>off: saves &times;1.5</td>"), std::string::npos) << html;
    EXPECT_NE(html.find("<td>lens</td><td>no</td><td></td><td></td>"), std::string::npos) << html;
}

TEST(Predictions, AreHeldAgainstWhatCame) {
    // Half of 0.4 comes at 4 s, half of 0.2 at 16 s; the end of the render, too.
    std::vector<PassRow> passes = {pass_row(1, 0.4), pass_row(4, 0.2), pass_row(16, 0.1)};
    passes[0].halving = {3.3, "firm"};    // 3 s: within 15 %
    passes[0].target = {16, "learning"};  // 15 s: a bound that held
    passes[1].halving = {9, "noisy"};     // 12 s: not within
    passes[1].target = {10, "learning"};  // 12 s: a bound that did not hold
    passes[2].halving = {1, "firm"};      // nobody knows
    passes[2].estimate = 0.2;             // wrong, and so is its interval
    passes[2].estimate_low = 0.18;
    passes[2].estimate_high = 0.22;
    const CellResult one = table_cell("all", 0, passes);
    const Predictions p = predictions_of({&one});
    EXPECT_EQ(p.intervals, 3);
    EXPECT_EQ(p.covered, 2);
    EXPECT_EQ(p.firm.made, 1);
    EXPECT_EQ(p.firm.within, 1);
    EXPECT_NEAR(p.firm.ratios.at(0), 1.1, 1e-9);
    EXPECT_EQ(p.learning.made, 2);
    EXPECT_EQ(p.learning.within, 1);
    EXPECT_EQ(p.noisy.made, 1);
    EXPECT_EQ(p.noisy.within, 0);
}

const char* const kBench = R"({"context": {}, "benchmarks": [
    {"run_name": "sums/floats", "family_index": 1, "run_type": "iteration", "items_per_second": 2e9, "order_changes": 0.5},
    {"run_name": "sums/exact", "family_index": 0, "run_type": "iteration", "items_per_second": 1e9, "order_changes": 0},
    {"run_name": "sums/exact", "family_index": 0, "run_type": "iteration", "items_per_second": 5e8, "order_changes": 0},
    {"run_name": "sums/floats", "family_index": 1, "run_type": "iteration", "items_per_second": 1e9, "order_changes": 0.5},
    {"run_name": "sums/exact", "run_type": "aggregate", "aggregate_name": "cv", "items_per_second": 7e8, "order_changes": NaN}]})";

TEST(TreePictures, OfTheFirstCellThatWasInspectedStandInThePage) {
    StudyResults results = study_of({{"ppg", {}}, {"none", {}}},
                                    {table_cell("ppg", 0, {}), table_cell("ppg", 1, {}), table_cell("none", 0, {})});
    for (CellResult& one : results.cells)
        one.folder = fresh_folder("trees");
    EXPECT_EQ(tree_pictures(results, results.scenes[0]), "") << "nothing was inspected";
    const std::filesystem::path folder = results.cells[1].folder / "inspect";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "a.png") << "Man";
    std::ofstream(folder / "inspect.json")
        << R"({"tree": {"regions": 12, "t1_cells": 345, "t2_share": 0.5, "t2_cells": 6},
               "places": [{"place": "pixel 1,2", "pictures": [{"file": "elsewhere/a.png", "panels": ["T1", "L & E"],
                                                               "overlap": 0.75, "white": 2.5}]}],
               "maps": [{"kind": "regions", "file": "a.png"}]})";
    const std::string html = tree_pictures(results, results.scenes[0]);
    for (const char* part : {"<h4>ppg</h4>", "12 regions, 345 cells", "50.0 %", "data:image/png;base64,TWFu\"",
                             "pixel 1,2: T1 | L &amp; E; overlap 75 %", "regions</figcaption>"})
        EXPECT_NE(html.find(part), std::string::npos) << part << " in " << html;
    std::ofstream(folder / "inspect.json") << "{}";
    EXPECT_THROW(tree_pictures(results, results.scenes[0]), InputError);
    std::filesystem::remove(folder / "a.png");
    EXPECT_EQ(base64({'M', 'a'}), "TWE=");
    EXPECT_EQ(base64({}), "");
}

TEST(BenchTable, PairsRepetitions) {
    const auto file = fresh_folder("bench") / "out.json";
    std::ofstream(file) << kBench;
    const std::vector<BenchChoice> choices = read_bench(file);
    ASSERT_EQ(choices.size(), 1u);
    ASSERT_EQ(choices[0].variants.size(), 2u);
    EXPECT_EQ(choices[0].variants[1].nanoseconds.size(), 2u);
    const std::string table = bench_table(choices);
    EXPECT_NE(table.find("| sums | exact | 1.4 |  | order changes: 0 |"), std::string::npos) << table;
    EXPECT_NE(table.find("| sums | floats | 0.7 | 0.50 [0.50, 0.50] | order changes: 0.5 |"), std::string::npos)
        << table;
    const StudyResults study = study_of({{"all", {}}}, {table_cell("all", 0, {pass_row(1, 0.1)})});
    EXPECT_NE(price_list({study}, choices).find("## Exactness"), std::string::npos);
    EXPECT_EQ(price_list({study}, {}).find("## Exactness"), std::string::npos);
    BenchChoice materials = choices[0];
    materials.name = "materials";
    const std::string list = price_list({study}, {choices[0], materials});
    EXPECT_LT(list.find("## Materials"), list.find("## Exactness"));
    EXPECT_EQ(price_list({study}, choices).find("## Materials"), std::string::npos);
}

TEST(PriceList, NamesStudyAndScene) {  // two studies may have one scene
    StudyResults study = study_of({{"all", {}}}, {table_cell("all", 0, {pass_row(1, 0.1)})});
    study.study = "configs/studies/choices.toml";
    const std::string list = price_list({study}, {});
    EXPECT_NE(list.find("\n## choices: room\n"), std::string::npos) << list;
}

TEST(BenchTable, RefusesWhatIsNone) {
    const auto file = fresh_folder("bench") / "out.json";
    std::ofstream(file) << "{}";
    EXPECT_THROW(read_bench(file), InputError);
    EXPECT_THROW(read_bench(file.string() + ".not"), InputError);
}

}  // namespace
}  // namespace treefarm
