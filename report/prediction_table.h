// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Forecasts of one kind that a render made, against when it came.
struct Held {
    int made = 0;
    int within = 0;              ///< off by 15 % at most; of bounds ("learning"): at most 15 % beyond
    std::vector<double> ratios;  ///< forecast over actual seconds from the pass on
};

/// Predictions by the passes of some cells, against what was.
struct Predictions {
    std::vector<double> error_ratios;  ///< estimated over measured error
    int intervals = 0, covered = 0;    ///< 95 % intervals of the error, and those that held the measured one
    Held firm, learning, noisy;        ///< forecasts of half the error, and of budget.error
};

Predictions predictions_of(const std::vector<const CellResult*>& cells);

/// Predicted against actual, a row per method, as HTML.
std::string prediction_table(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
