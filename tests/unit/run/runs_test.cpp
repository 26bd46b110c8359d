// SPDX-License-Identifier: Apache-2.0
// Files of a run: their tables, the programs that write by them, and what earlier versions wrote.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/runs/run_json.h"
#include "coordinator/render/finished_render.h"
#include "coordinator/run/folder_content.h"
#include "coordinator/run/pass_record.h"
#include "report/run_results.h"
#include "serve/pass_table.h"
#include "tests/support/command.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

/// A folder that a program of an earlier version wrote.
fs::path stored(const std::string& name) {
    return fs::path(TREEFARM_SOURCE_DIR) / "tests/support/stored_runs" / name;
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

/// Names of the figures at a place, in the table's order.
std::vector<std::string> names_at(unsigned place) {
    std::vector<std::string> names;
    for (const PassFigure& figure : kPassFigures)
        if (figure.places & place) names.emplace_back(figure.name);
    return names;
}

std::vector<std::string> keys_of(const RunJson& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items())
        keys.push_back(key);
    return keys;
}

/// Paths of all keys of a file, but for figures of passes, which the other table has.
void add_paths(const RunJson& json, const std::string& path, std::set<std::string>& paths) {
    if (json.is_array())
        for (const RunJson& element : json)
            add_paths(element, path, paths);
    if (!json.is_object() || path == "passes.") return;
    for (const auto& [key, value] : json.items()) {
        paths.insert(path + key);
        add_paths(value, path + key + ".", paths);
    }
}

TEST(RunTables, SayUnitAndMeaningOfEachFigureOnce) {
    std::set<std::string> names;
    for (const PassFigure& figure : kPassFigures) {
        EXPECT_TRUE(names.insert(figure.name).second) << figure.name << " is there twice";
        EXPECT_STRNE(figure.unit, "") << figure.name;
        EXPECT_STRNE(figure.meaning, "") << figure.name;
        EXPECT_NE(figure.places, 0u) << figure.name;
        EXPECT_EQ(current_name(figure.name), figure.name);
    }
    for (const PassFigure& figure : kPassFigures)
        for (const std::string& former : split(figure.former, ' ')) {
            if (former.empty()) continue;
            EXPECT_TRUE(names.insert(former).second) << former << " is also the name of another figure";
            EXPECT_EQ(current_name(former), figure.name);
        }
    EXPECT_EQ(current_name("no such column"), "no such column");
    EXPECT_EQ(current_name(""), "");
}

TEST(RunTables, SayUnitAndMeaningOfEachKeyAndFileOnce) {
    std::set<std::string> paths, files;
    for (const RunKeyRow& row : kRunKeys) {
        EXPECT_TRUE(paths.insert(row.path).second) << row.path << " is there twice";
        EXPECT_STRNE(row.unit, "") << row.path;
        EXPECT_STRNE(row.meaning, "") << row.path;
        EXPECT_NE(row.places, 0u) << row.path;
    }
    for (const RunFile& file : kRunFiles) {
        EXPECT_TRUE(files.insert(file.name).second) << file.name << " is there twice";
        EXPECT_STRNE(file.meaning, "") << file.name;
    }
    for (const RunFile& file : kRunFolders)
        EXPECT_STRNE(file.meaning, "") << file.name;
}

TEST(RunTables, AreWhatThePassReportWrites) {
    const PassReport report{};
    EXPECT_EQ(split(pass_csv_header(), ','), names_at(kInTable));
    for (const unsigned place : {kInTable, kInSummary})
        EXPECT_EQ(keys_of(pass_record(report, place)), names_at(place)) << "values in another order than their names";
    std::vector<std::string> cell = keys_of(pass_record(report, kInCell));
    EXPECT_EQ(cell, names_at(kInCell));
    EXPECT_EQ(split(pass_csv_line(report), ',').size(), names_at(kInTable).size());
}

TEST(RunTables, AnUnknownFigureIsAnEmptyFieldOrNull) {
    PassReport report;
    report.plan.guided = true;
    report.halving.trust = Trust::firm;
    const std::vector<std::string> names = names_at(kInTable), fields = split(pass_csv_line(report), ',');
    const auto field = [&](const char* name) {
        return fields.at(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
    };
    for (const char* name : {"error", "error_low", "efficiency", "halving_spp", "target_trust", "profile_shadow"})
        EXPECT_EQ(field(name), "") << name;
    EXPECT_EQ(field("halving_trust"), "firm");
    EXPECT_EQ(field("guided"), "1");
    const RunJson record = pass_record(report, kInCell);
    EXPECT_TRUE(record["image_error"].is_null());
    EXPECT_TRUE(record["target"].is_null());
    EXPECT_EQ(record["guided"], true);
    report.error = {.known = true, .rmse = 0.5, .mean = 2};
    report.target = {.relative_error = 0.1, .spp = 64, .seconds = 8, .trust = Trust::noisy};
    EXPECT_EQ(pass_record(report, kInSummary)["image_error"]["relative"], 0.25);
    EXPECT_TRUE(pass_record(report, kInSummary)["image_error"]["low"].is_null()) << "it has no interval";
    EXPECT_EQ(pass_record(report, kInCell)["target"]["trust"], "noisy");
}

TEST(RunTables, AreWhatARenderWrites) {
    const fs::path run = test::fresh_test_folder() / "run";
    const test::Ended ended = test::run_treefarm(
        "render " + test::own_scene("cornell-box.xml") +
        " --set image.width=64 --set image.height=64 --error 0.1% --set budget.max_spp=7 --run-dir " + run.string() +
        " --threads 1");
    ASSERT_TRUE(ended.code == 0 || ended.code == 4) << ended.output;
    for (const auto& [file, place] : {std::pair(kSummaryFile, kInSummary), std::pair(kStatusFile, kInStatus)}) {
        std::set<std::string> written, known;
        add_paths(RunJson::parse(text_of(run / file)), "", written);
        for (const RunKeyRow& row : kRunKeys)
            if (row.places & place) known.insert(row.path);
        for (const std::string& path : written)
            EXPECT_TRUE(known.contains(path)) << file << ": " << path << " has no row";
        if (place == kInSummary) {
            for (const std::string& path : known)
                EXPECT_TRUE(written.contains(path) || path.starts_with("crop.") || path.starts_with("halving.") ||
                            path.starts_with("tail_worst.") || path == "attempt" || path == "error")
                    << path << " is not written";
        }
    }
    const RunJson summary = RunJson::parse(text_of(run / kSummaryFile));
    EXPECT_EQ(keys_of(summary["passes"].back()), names_at(kInSummary));
    std::set<std::string> files;
    for (const RunFile& file : kRunFiles)
        files.insert(file.name);
    for (const auto& entry : fs::directory_iterator(run)) {
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(files.contains(name) || name == kCheckpointFolder || name == kLockFileName) << name;
    }
    fs::remove_all(run);
}

TEST(StoredRuns, OfAnEarlierVersionAreReadByTheirFormerNames) {
    const RunJson summary = read_run_json(stored("render") / kSummaryFile);
    const RunJson written = RunJson::parse(text_of(stored("render") / kSummaryFile));
    ASSERT_EQ(summary["passes"].size(), written["passes"].size());
    for (std::size_t k = 0; k < written["passes"].size(); ++k) {
        EXPECT_EQ(keys_of(summary["passes"][k]).size(), keys_of(written["passes"][k]).size());
        for (const auto& [name, value] : written["passes"][k].items())
            EXPECT_EQ(summary["passes"][k].at(std::string(current_name(name))), value) << name;
    }
    EXPECT_TRUE(written["passes"][0].contains("guiding_worth"));
    std::vector<std::string> names = split(split(text_of(stored("render") / kPassesFile), '\n').front(), ',');
    for (std::string& name : names)
        name = std::string(current_name(name));
    std::vector<std::string> known = names_at(kInTable);
    std::erase(known, "busy_seconds");  // a later column
    EXPECT_EQ(names, known);
}

TEST(StoredRuns, AreReportedListedAndKnownAsDone) {
    const std::vector<fs::path> folders = {stored("render")};
    const StudyResults results = read_run_results(folders);
    ASSERT_EQ(results.cells.size(), 1u);
    const RunJson written = RunJson::parse(text_of(stored("render") / kSummaryFile));
    const PassRow& last = results.cells[0].passes.back();
    EXPECT_EQ(last.estimate, written["passes"].back()["image_error"]["relative"]);
    EXPECT_EQ(last.tree_memory, written["passes"].back()["tree_memory"]);
    EXPECT_EQ(last.phases.size(), 6u);
    EXPECT_EQ(results.cells[0].made.source, written["build"]["source"]);
    EXPECT_EQ(folder_content(stored("render")), FolderContent::render);
    EXPECT_EQ(render_words(stored("render")), "done, " + written["spp"].dump() + " spp");
    EXPECT_EQ(read_figures(stored("render")).error, written["image_error"]["relative"].get<double>());
    EXPECT_EQ(pass_table(text_of(stored("render") / kPassesFile)).size(), written["passes"].size());
}

TEST(StoredRuns, OfAStudyHaveTheirPassesByFormerNames) {
    const StudyResults results = read_study_results(stored("study"));
    ASSERT_EQ(results.cells.size(), 2u);
    for (const CellResult& cell : results.cells) {
        const RunJson written = RunJson::parse(text_of(cell.folder / kCellFile))["passes"].back();
        const PassRow& row = cell.passes.back();
        EXPECT_EQ(row.estimate, written["estimate"]["relative"]);
        EXPECT_EQ(row.estimate_high, written["estimate"]["high"]);
        EXPECT_EQ(row.halving.seconds, written["halving_seconds"]);
        EXPECT_EQ(row.halving.trust, written["halving_trust"]);
        EXPECT_TRUE(std::isnan(row.target.seconds)) << "no error was asked for";
        EXPECT_EQ(row.phases.at("collect"), written["phases"]["collect"]);
        EXPECT_EQ(row.core_seconds, written["core_seconds"]);
        EXPECT_EQ(row.measured.at("rel_mse"), written["measured"]["rel_mse"]);
    }
}

TEST(RunJson, DamagedAndForeignFilesHaveNoKeys) {
    EXPECT_TRUE(read_run_json(stored("render") / "nothing.json").empty());
    std::string deep = "1";
    for (int k = 0; k < 100; ++k)
        deep = "[" + deep + "]";
    for (const std::string& text : {std::string(), std::string("{"), std::string("[]"), std::string("null"),
                                    std::string("{\"state\": "), "{\"state\": " + deep + "}"})
        EXPECT_EQ(text_in(parse_run_json(text), "state"), "") << text;
    const RunJson json = parse_run_json(R"({"state": 7, "spp": "many", "farm": [], "passes": [1, {"worth": 2},
        {"guiding_efficiency": 3, "worth": 4}, {"halving": 5, "halving_seconds": 6}], "target": {"reached": 0}})");
    EXPECT_EQ(text_in(json, "state"), "");
    EXPECT_EQ(number_in(json, "spp", -1), -1);
    EXPECT_TRUE(object_of(json, "farm").is_null());
    EXPECT_EQ(number_in(array_of(json, "passes")[1], "guiding_efficiency"), 2);
    EXPECT_EQ(number_in(array_of(json, "passes")[2], "guiding_efficiency"), 3) << "the current name counts";
    EXPECT_EQ(array_of(json, "passes")[3]["halving"], 5);
    EXPECT_FALSE(missed_target(json));
    EXPECT_FALSE(missed_target(parse_run_json("{}")));
    EXPECT_TRUE(missed_target(parse_run_json(R"({"target": {"reached": false}})")));
    EXPECT_TRUE(array_of(parse_run_json(R"({"passes": 3})"), "passes").empty());
}

}  // namespace
}  // namespace treefarm
