#include "report/study_results.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/base/error.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& path) {
    std::ifstream file(path);
    try {
        return Json::parse(file);
    } catch (const Json::exception& error) {
        throw InputError(Location{path.string()}, std::string("cannot be read: ") + error.what(),
                         "remove it and run the study again");
    }
}

double number(const Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::map<std::string, double> numbers(const Json& object) {
    std::map<std::string, double> values;
    for (const auto& [key, value] : object.items())
        values[key] = number(value);
    return values;
}

/// Folders of earlier versions do not know how far a forecast was trusted, and have none of the target.
Prediction read_prediction(const Json& json, const std::string& of) {
    const std::string seconds = of + "_seconds", trust = of + "_trust";
    Prediction prediction{std::numeric_limits<double>::quiet_NaN(), ""};
    if (json.contains(seconds)) prediction.seconds = number(json[seconds]);
    if (json.contains(trust)) prediction.trust = json[trust];
    return prediction;
}

PassRow read_pass(const Json& json) {
    PassRow row;
    row.pass = json.at("pass");
    row.spp = json.at("spp");
    row.spp_done = json.at("spp_done");
    row.threads = json.at("threads");
    row.run_seconds = json.at("run_seconds");
    row.core_seconds = json.at("core_seconds");
    row.measured = numbers(json.at("measured"));
    const Json& estimate = json.at("estimate");
    row.estimate = number(estimate.is_null() ? Json() : estimate.at("relative"));
    row.estimate_low = number(estimate.is_null() ? Json() : estimate.at("low"));
    row.estimate_high = number(estimate.is_null() ? Json() : estimate.at("high"));
    row.halving = read_prediction(json, "halving");
    row.target = read_prediction(json, "target");
    row.stuv = json.at("stuv");
    row.ttuv = json.at("ttuv");
    row.nonzero_share = json.at("nonzero_share");
    row.tree_nodes = json.at("tree_nodes");
    row.tree_memory = json.at("tree_memory");
    row.phases = numbers(json.at("phases"));
    row.worker_seconds = numbers(json.at("worker_seconds"));
    row.idle_seconds = json.at("idle_seconds");
    return row;
}

CellResult read_cell(const Json& place, const std::filesystem::path& folder) {
    const Json json = read_json(folder / "cell.json");
    CellResult cell{place.at("scene"),
                    place.at("method"),
                    place.at("seed"),
                    place.at("repetition"),
                    folder,
                    json.at("width"),
                    json.at("height"),
                    number(json.at("flip")),
                    {}};
    for (const Json& pass : json.at("passes"))
        cell.passes.push_back(read_pass(pass));
    return cell;
}

void read_description(const Json& json, StudyResults& results) {
    results.study = json.at("study");
    results.baseline = json.at("baseline");
    for (const auto& [key, value] : json.at("budget").items())
        results.budget = key + " = " + value.get<std::string>();
    for (const Json& scene : json.at("scenes")) {
        SceneResult of{scene.at("name"), scene.at("file"), "", std::numeric_limits<double>::quiet_NaN(), false};
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

std::vector<const CellResult*> StudyResults::of(const std::string& scene, const std::string& method) const {
    std::vector<const CellResult*> found;
    for (const CellResult& cell : cells)
        if (cell.scene == scene && cell.method == method) found.push_back(&cell);
    return found;
}

StudyResults read_study_results(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "study.json"))
        throw InputError(Location{folder.string()}, "is no folder of a study: it holds no study.json",
                         "give the folder that treefarm study wrote");
    StudyResults results;
    results.folder = folder;
    try {
        const Json json = read_json(folder / "study.json");
        read_description(json, results);
        for (const Json& place : json.at("cells")) {
            const std::filesystem::path cell = folder / "cells" / place.at("folder").get<std::string>();
            if (std::filesystem::exists(cell / "cell.json")) results.cells.push_back(read_cell(place, cell));
        }
    } catch (const Json::exception& error) {
        throw InputError(Location{folder.string()}, std::string("what a study left is damaged: ") + error.what(),
                         "remove the folder and run the study again");
    }
    if (results.cells.empty())
        throw InputError(Location{folder.string()}, "no cell is done yet", "run the study first");
    return results;
}

const std::vector<Measure>& measures() {
    static const std::vector<Measure> all = {
        {"rmse_over_mean", "RMSE / mean", rmse_over_mean},
        {"root_rel_mse", "root of relMSE", root_rel_mse},
        {"root_rel_mse_trimmed", "root of relMSE, worst 0.1 % dropped", root_rel_mse_trimmed}};
    return all;
}

std::vector<CurvePoint> curve_of(const CellResult& cell, const Measure& measure) {
    std::vector<CurvePoint> curve;
    for (const PassRow& row : cell.passes)
        if (measure.value(row) > 0 && row.run_seconds > 0) curve.push_back({row.run_seconds, measure.value(row)});
    return curve;
}

}  // namespace treefarm
