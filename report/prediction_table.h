// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Forecasts of one kind, compared with the actual times.
struct Held {
    int made = 0;
    /// number of forecasts off by at most 15 %; of bounds ("learning"): at most 15 % too low
    int within = 0;
    std::vector<double> ratios;  ///< forecast over actual seconds from the pass on
};

/// Forecasts of some cells' passes, compared with the actual results.
struct Predictions {
    std::vector<double> error_ratios;  ///< estimated over measured error
    /// number of 95 % intervals of the error, and of those that contain the measured one
    int intervals = 0, covered = 0;
    Held firm, learning, noisy;  ///< forecasts of half the error, and of budget.error
};

Predictions predictions_of(const std::vector<const CellResult*>& cells);

/// Forecast against actual values, a row per method, as HTML.
std::string prediction_table(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
