// SPDX-License-Identifier: Apache-2.0
#include "report/prediction_table.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "report/figure_text.h"
#include "report/html.h"

namespace treefarm {

namespace {

/// Largest relative deviation of a correct forecast.
constexpr double kTolerance = 0.15;

Held* kind_of(Predictions& predictions, const std::string& trust) {
    if (trust == "firm") return &predictions.firm;
    if (trust == "learning") return &predictions.learning;
    return trust == "noisy" ? &predictions.noisy : nullptr;
}

void judge(Predictions& predictions, const Prediction& forecast, double actual) {
    Held* held = kind_of(predictions, forecast.trust);
    if (!held || !std::isfinite(forecast.seconds) || !(actual > 0) || !(forecast.seconds > 0)) return;
    const double ratio = forecast.seconds / actual;
    ++held->made;
    const bool is_bound = held == &predictions.learning;
    held->within += ratio > 1 / (1 + kTolerance) && (is_bound || ratio < 1 + kTolerance);
    held->ratios.push_back(ratio);
}

std::string median_text(std::vector<double> values) {
    if (values.empty()) return "";
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return fmt::format("{:.2f}", *middle);
}

std::string fraction_text(int part, int all) {
    return all == 0 ? "" : fmt::format("{} of {}", part, all);
}

}  // namespace

Predictions predictions_of(const std::vector<const CellResult*>& cells) {
    Predictions predictions;
    const Measure& measure = measures().front();
    for (const CellResult* cell : cells) {
        const std::vector<CurvePoint> curve = curve_of(*cell, measure);
        for (const PassRow& row : cell->passes) {
            const double measured = measure.value(row);
            if (row.estimate > 0 && measured > 0) predictions.error_ratios.push_back(row.estimate / measured);
            if (std::isfinite(row.estimate_low) && row.estimate_low < row.estimate_high) {
                ++predictions.intervals;
                predictions.covered += row.estimate_low <= measured && measured <= row.estimate_high;
            }
            const Crossing half = time_to(curve, 0.5 * measured);
            if (!half.extrapolated) judge(predictions, row.halving, half.seconds - row.run_seconds);
            // A render with a target error ended when it was reached.
            if (&row != &cell->passes.back())
                judge(predictions, row.target, cell->passes.back().run_seconds - row.run_seconds);
        }
    }
    return predictions;
}

std::string prediction_table(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::string>> rows = {{"method", "estimated / measured error", "interval held it",
                                                   "forecasts within 15 %", "median of forecast / actual",
                                                   "\"at most\" that held", "\"roughly\" within 15 %"}};
    for (const MethodResult& method : results.methods) {
        const auto cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const Predictions p = predictions_of(cells);
        rows.push_back({html_text(method.name),
                        p.error_ratios.empty() ? "" : interval_text(geometric_mean(p.error_ratios)),
                        fraction_text(p.covered, p.intervals), fraction_text(p.firm.within, p.firm.made),
                        median_text(p.firm.ratios), fraction_text(p.learning.within, p.learning.made),
                        fraction_text(p.noisy.within, p.noisy.made)});
    }
    return html_table(rows);
}

}  // namespace treefarm
