// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/provenance.h"
#include "report/statistics.h"

namespace treefarm {

/// Forecast of a render's remaining time after a pass.
struct Prediction {
    double seconds = 0;  ///< NaN: none
    std::string trust;   ///< "firm", "noisy", "learning" (a bound); empty: none
};

/// One pass of a cell, as in cell.json.
struct PassRow {
    int pass = 0, spp = 0, spp_done = 0, threads = 0;
    double run_seconds = 0, core_seconds = 0;    ///< both since the start of rendering
    std::map<std::string, double> measured;      ///< rmse_over_mean, rel_mse, ...
    double estimate = 0;                         ///< relative error estimated by the render; NaN: none
    double estimate_low = 0, estimate_high = 0;  ///< its 95 % interval; NaN: none
    Prediction halving;                          ///< until half of that error
    Prediction target;                           ///< until budget.error
    double stuv = 0, ttuv = 0, nonzero_share = 0, tree_nodes = 0, tree_memory = 0;
    std::map<std::string, double> phases;  ///< seconds of the coordinator's clock
    std::map<std::string, double> worker_seconds;
    double idle_seconds = 0;
};

/// A pass as summary.json and cell.json list it, with what both have. Throws RunJson::exception.
PassRow read_pass(const nlohmann::ordered_json& json);

struct CellResult {
    std::string scene, method;
    std::uint64_t seed = 0;
    std::size_t repetition = 0;
    std::filesystem::path folder;
    int width = 0, height = 0;
    double flip = 0;
    std::vector<PassRow> passes;
    std::string budget;  ///< "seconds = 2"
    Provenance made;
};

struct SceneResult {
    std::string name, file, reference_file;
    double reference_error = 0;  ///< its own estimate; NaN: unknown
    bool reference_rendered = false;
};

struct MethodResult {
    std::string name;
    std::map<std::string, std::string> settings;
};

/// Measure of errors in tables and plots.
struct Measure {
    const char* key;
    const char* name;  ///< for readers
    double (*value)(const PassRow&);
};
/// Error measures: RMSE / mean; the root of relMSE; that root without the worst 0.1 % of the pixels. A claim needs both
/// of the latter.
const std::vector<Measure>& measures();
/// Measures without those that equal an earlier one in every pass: of less than 1000 pixels none is among the worst
/// 0.1 %.
std::vector<Measure> distinct_measures(const std::vector<CellResult>& cells);

/// Clock by which time is counted.
struct Clock {
    const char* key;
    const char* name;  ///< for readers, in the plural
    double (*value)(const PassRow&);
};
/// Clocks: seconds, which other programs on the machine lengthen, and core-seconds, which they hardly affect.
const std::vector<Clock>& clocks();

/// Results of a study, complete or not.
struct StudyResults {
    std::filesystem::path folder;
    std::string study, baseline;
    std::vector<std::string> budgets;               ///< "seconds = 2", in the study's order
    std::vector<Measure> measured_by = measures();  ///< the first one decides the winner
    bool has_references = true;                     ///< false: errors are the renders' own estimates
    std::vector<SceneResult> scenes;
    std::vector<MethodResult> methods;
    std::size_t planned = 0;        ///< number of cells
    std::vector<CellResult> cells;  ///< finished ones, in order

    /// Cells of a scene and method, by repetition.
    std::vector<const CellResult*> of(const std::string& scene, const std::string& method) const;

    /// Results with the cells of one budget only.
    StudyResults of_budget(const std::string& budget) const;
};

/// Results in a folder that `treefarm study` wrote. Throws InputError if it is none, or damaged.
StudyResults read_study_results(const std::filesystem::path& folder);

std::vector<CurvePoint> curve_of(const CellResult& cell, const Measure& measure, const Clock& clock = clocks().front());

}  // namespace treefarm
