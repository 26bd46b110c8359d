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

/// How long a render said that it would take from a pass on.
struct Prediction {
    double seconds = 0;  ///< NaN: none
    std::string trust;   ///< "firm", "noisy", "learning" (a bound); empty: none
};

/// One pass of a cell, as cell.json has it.
struct PassRow {
    int pass = 0, spp = 0, spp_done = 0, threads = 0;
    double run_seconds = 0, core_seconds = 0;    ///< both since the render began
    std::map<std::string, double> measured;      ///< rmse_over_mean, rel_mse, ...
    double estimate = 0;                         ///< relative error that the render claimed; NaN: none
    double estimate_low = 0, estimate_high = 0;  ///< its 95 % interval; NaN: none
    Prediction halving;                          ///< until half of that error
    Prediction target;                           ///< until budget.error
    double stuv = 0, ttuv = 0, nonzero_share = 0, tree_nodes = 0, tree_memory = 0;
    std::map<std::string, double> phases;  ///< seconds of the coordinator's clock
    std::map<std::string, double> worker_seconds;
    double idle_seconds = 0;
};

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
    double reference_error = 0;  ///< that it claims of itself; NaN: not known
    bool reference_rendered = false;
};

struct MethodResult {
    std::string name;
    std::map<std::string, std::string> settings;
};

/// How errors are measured in tables and plots.
struct Measure {
    const char* key;
    const char* name;  ///< for people
    double (*value)(const PassRow&);
};
/// RMSE / mean; the root of relMSE; that root without the worst 0.1 % of the pixels. A claim needs both of the latter.
const std::vector<Measure>& measures();

/// A way of counting time.
struct Clock {
    const char* key;
    const char* name;  ///< for people, in the plural
    double (*value)(const PassRow&);
};
/// Seconds, which other programs on the machine lengthen, and core-seconds, which they hardly do.
const std::vector<Clock>& clocks();

/// A study as far as it has come.
struct StudyResults {
    std::filesystem::path folder;
    std::string study, baseline;
    std::vector<std::string> budgets;               ///< "seconds = 2", in the study's order
    std::vector<Measure> measured_by = measures();  ///< the first decides who won
    bool has_references = true;                     ///< without, errors are those that renders claim of themselves
    std::vector<SceneResult> scenes;
    std::vector<MethodResult> methods;
    std::size_t planned = 0;        ///< cells
    std::vector<CellResult> cells;  ///< done ones, in order

    /// Cells of a scene and method, by repetition.
    std::vector<const CellResult*> of(const std::string& scene, const std::string& method) const;

    /// Results with the cells of one budget only.
    StudyResults of_budget(const std::string& budget) const;
};

/// Reads the folder that `treefarm study` left. Throws InputError where it is none, or damaged.
StudyResults read_study_results(const std::filesystem::path& folder);

std::vector<CurvePoint> curve_of(const CellResult& cell, const Measure& measure, const Clock& clock = clocks().front());

}  // namespace treefarm
