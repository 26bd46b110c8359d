// SPDX-License-Identifier: Apache-2.0
#include "report/study_results.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/runs/run_json.h"

namespace treefarm {

namespace {

using Json = RunJson;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Json read_json(const std::filesystem::path& path) {
    try {
        return read_whole_run_json(path);
    } catch (const Json::exception& error) {
        throw InputError(Location{path.string()}, std::string("cannot be read: ") + error.what(),
                         "remove it and run the study again");
    }
}

double number(const Json& value) {
    return value.is_number() ? value.get<double>() : kNone;
}

std::map<std::string, double> numbers(const Json& object) {
    std::map<std::string, double> values;
    for (const auto& [key, value] : object.items())
        values[key] = number(value);
    return values;
}

/// Forecast of a pass; folders of earlier versions have no trust, and no forecast of the target.
Prediction read_prediction(const RunJson& forecast) {
    return {number_in(forecast, "seconds", kNone), text_in(forecast, "trust")};
}

PassRow read_cell_pass(const RunJson& json) {
    PassRow row = read_pass(json);
    row.threads = json.at("threads");
    row.measured = numbers(json.at("measured"));
    row.halving = read_prediction(object_of(json, "halving"));
    row.target = read_prediction(object_of(json, "target"));
    row.stuv = json.at("stuv");
    row.ttuv = json.at("ttuv");
    row.worker_seconds = numbers(json.at("worker_seconds"));
    row.idle_seconds = json.at("idle_seconds");
    return row;
}

CellResult read_cell(const Json& entry, const std::filesystem::path& folder, const std::string& budget) {
    const Json json = read_json(folder / kCellFile);
    CellResult cell;
    cell.scene = entry.at("scene");
    cell.method = entry.at("method");
    cell.seed = entry.at("seed");
    cell.repetition = entry.at("repetition");
    cell.folder = folder;
    cell.width = json.at("width");
    cell.height = json.at("height");
    cell.flip = number(json.at("flip"));
    cell.budget = budget;
    cell.made = read_provenance(folder);
    for (const Json& pass : json.at("passes"))
        cell.passes.push_back(read_cell_pass(pass));
    return cell;
}

/// Texts of the budgets; folders of earlier versions have one, without a list of values.
std::vector<std::string> read_budgets(const Json& budget) {
    std::vector<std::string> budgets;
    for (const auto& [key, values] : budget.items()) {
        const std::string name = key.substr(key.find('.') + 1) + " = ";
        if (values.is_string()) budgets.push_back(name + values.get<std::string>());
        if (values.is_array())
            for (const Json& value : values)
                budgets.push_back(name + value.get<std::string>());
    }
    if (budgets.empty()) throw InputError(Location{"study.json"}, "names no budget", "run the study again");
    return budgets;
}

void read_description(const Json& json, StudyResults& results) {
    results.study = json.at("study");
    results.baseline = json.at("baseline");
    results.budgets = read_budgets(json.at("budget"));
    for (const Json& scene : json.at("scenes")) {
        SceneResult of{scene.at("name"), scene.at("file"), "", kNone, false};
        if (scene.contains("reference")) {
            const Json& reference = scene["reference"];
            of.reference_file = reference.at("file");
            of.reference_rendered = reference.at("rendered");
            if (reference.contains("error")) of.reference_error = number(reference["error"]);
        }
        results.scenes.push_back(std::move(of));
    }
    for (const Json& method : json.at("methods"))
        results.methods.push_back({method.at("name"), method.at("settings").get<std::map<std::string, std::string>>()});
    results.planned = json.at("cells").size();
}

double rmse_over_mean(const PassRow& row) {
    return row.measured.at("rmse_over_mean");
}

double root_rel_mse(const PassRow& row) {
    return std::sqrt(row.measured.at("rel_mse"));
}

double root_rel_mse_trimmed(const PassRow& row) {
    return std::sqrt(row.measured.at("rel_mse_trimmed"));
}

}  // namespace

PassRow read_pass(const RunJson& json) {
    PassRow row;
    row.pass = json.at("pass");
    row.spp = json.at("spp");
    row.spp_done = json.at("spp_done");
    row.run_seconds = json.at("run_seconds");
    row.core_seconds = json.at("core_seconds");
    const RunJson error = object_of(json, "image_error");
    row.estimate = number_in(error, "relative", kNone);
    row.estimate_low = number_in(error, "low", kNone);
    row.estimate_high = number_in(error, "high", kNone);
    row.halving = row.target = {kNone, ""};
    row.nonzero_share = json.at("nonzero_share");
    row.tree_nodes = json.at("tree_nodes");
    row.tree_memory = json.at("tree_memory");
    row.phases = numbers(json.at("phase_seconds"));
    return row;
}

std::vector<const CellResult*> StudyResults::of(const std::string& scene, const std::string& method) const {
    std::vector<const CellResult*> found;
    for (const CellResult& cell : cells)
        if (cell.scene == scene && cell.method == method) found.push_back(&cell);
    return found;
}

StudyResults StudyResults::of_budget(const std::string& budget) const {
    StudyResults part = *this;
    part.budgets = {budget};
    std::erase_if(part.cells, [&](const CellResult& cell) { return cell.budget != budget; });
    return part;
}

StudyResults read_study_results(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / kStudyFile))
        throw InputError(Location{folder.string()},
                         "holds neither a study (study.json) nor a render that ended (summary.json)",
                         "give a folder that treefarm study or treefarm render wrote");
    StudyResults results;
    results.folder = folder;
    try {
        const Json json = read_json(folder / kStudyFile);
        read_description(json, results);
        for (const Json& entry : json.at("cells")) {
            const std::filesystem::path cell = folder / kCellsFolder / entry.at("folder").get<std::string>();
            if (std::filesystem::exists(cell / kCellFile)) {
                const std::size_t budget = entry.value("budget", std::size_t{0});
                results.cells.push_back(read_cell(entry, cell, results.budgets.at(budget)));
            }
        }
    } catch (const Json::exception& error) {
        throw InputError(Location{folder.string()}, std::string("what a study left is damaged: ") + error.what(),
                         "remove the folder and run the study again");
    }
    if (results.cells.empty())
        throw InputError(Location{folder.string()}, "no cell is done yet", "run the study first");
    results.measured_by = distinct_measures(results.cells);
    return results;
}

const std::vector<Measure>& measures() {
    static const std::vector<Measure> all = {
        {"rmse_over_mean", "RMSE / mean", rmse_over_mean},
        {"root_rel_mse", "root of relMSE", root_rel_mse},
        {"root_rel_mse_trimmed", "root of relMSE, worst 0.1 % dropped", root_rel_mse_trimmed}};
    return all;
}

std::vector<Measure> distinct_measures(const std::vector<CellResult>& cells) {
    std::vector<Measure> distinct;
    for (const Measure& measure : measures()) {
        const auto equals = [&](const Measure& earlier) {
            return std::all_of(cells.begin(), cells.end(), [&](const CellResult& cell) {
                return std::all_of(cell.passes.begin(), cell.passes.end(),
                                   [&](const PassRow& row) { return measure.value(row) == earlier.value(row); });
            });
        };
        if (std::none_of(distinct.begin(), distinct.end(), equals)) distinct.push_back(measure);
    }
    return distinct;
}

const std::vector<Clock>& clocks() {
    static const std::vector<Clock> all = {
        {"seconds", "seconds", [](const PassRow& row) { return row.run_seconds; }},
        {"core_seconds", "core-seconds", [](const PassRow& row) { return row.core_seconds; }}};
    return all;
}

std::vector<CurvePoint> curve_of(const CellResult& cell, const Measure& measure, const Clock& clock) {
    std::vector<CurvePoint> curve;
    for (const PassRow& row : cell.passes)
        if (measure.value(row) > 0 && clock.value(row) > 0) curve.push_back({clock.value(row), measure.value(row)});
    return curve;
}

}  // namespace treefarm
