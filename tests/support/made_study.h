// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "report/study_results.h"

// Results of studies that were never rendered, with errors chosen for what a report says of them.
namespace treefarm::test {

inline const SceneResult kRoom{"room", "room.xml", "room.exr", 0.001, true},
    kHall{"hall", "hall.xml", "hall.exr", 0.001, true};

/// A cell of two passes: the error falls as the inverse square root of time, to `error` after `seconds`.
inline CellResult cell(const std::string& scene, const std::string& method, std::size_t repetition, double error,
                       double fraction = 1, double rel_error = 0, double seconds = 4) {
    CellResult made;
    made.scene = scene;
    made.method = method;
    made.seed = repetition + 1;
    made.repetition = repetition;
    made.budget = "seconds = 4";
    for (const double part : {0.25, 1.0}) {
        PassRow row;
        row.pass = static_cast<int>(made.passes.size());
        row.spp_done = static_cast<int>(16 * part);
        row.threads = 2;
        row.run_seconds = part * seconds;
        row.core_seconds = part * seconds * 2 * fraction;
        row.phases = {{"collect", seconds * (made.passes.empty() ? 0.25 : 0.75)}};
        const double now = error / std::sqrt(part), rel = rel_error > 0 ? rel_error : now;
        row.measured = {{"rmse_over_mean", now}, {"rel_mse", rel * rel}, {"rel_mse_trimmed", rel * rel},
                        {"mape", now},           {"outliers", 0},        {"smape", now},
                        {"mean_ratio", 1}};
        row.estimate = now;
        row.halving = row.target = {NAN, ""};
        made.passes.push_back(row);
    }
    return made;
}

inline StudyResults study(std::vector<CellResult> cells, std::vector<SceneResult> scenes = {kRoom}) {
    StudyResults results;
    results.scenes = std::move(scenes);
    results.methods = {{"plain", {}}, {"guided", {}}};
    results.baseline = "plain";
    results.budgets = {"seconds = 4"};
    results.planned = cells.size();
    results.cells = std::move(cells);
    return results;
}

/// Seeds whose errors scatter by a few per cent around those of each method.
inline std::vector<CellResult> seeds(const std::string& scene, std::size_t count, double plain, double guided,
                                     double fraction = 1) {
    std::vector<CellResult> cells;
    for (std::size_t k = 0; k < count; ++k) {
        const double scatter = 1 + 0.02 * static_cast<double>(k % 3);
        cells.push_back(cell(scene, "plain", k, plain * scatter, fraction));
        cells.push_back(cell(scene, "guided", k, guided / scatter, fraction));
    }
    return cells;
}

inline void expect_part(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

inline void expect_no_part(const std::string& text, const std::string& part) {
    EXPECT_EQ(text.find(part), std::string::npos) << part << "\nis in\n" << text;
}

}  // namespace treefarm::test
