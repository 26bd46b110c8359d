// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/plan/forecast/outlook.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Whether the image consists of the passes of the last tree alone; with budget.strict, of the last pass.
bool shows_last_tree_only(const Resolved& job);

/// Samples per pixel of a further pass that brings the image's mean squared error to `mse`, for this variance of a
/// sample (docs/design/error.md, "error"). 0: already reached. Infinite: unknown.
double spp_to_reach(const RenderHistory& state, const Resolved& job, double mse, double variance);

/// Factor on the samples that budget.error needs, so that few ending passes suffice.
double ending_margin(const Resolved& job);
/// Variance of a sample assumed for ending passes, after `trees` further trees. A strict render cannot make up for a
/// tree that falls short, so it assumes the variance of the tree before.
double ending_variance(const Outlook& outlook, const Resolved& job, int trees);

/// Trust in a forecast.
enum class Trust : std::uint8_t {
    none,      ///< no data yet
    noisy,     ///< the error is not known well enough, or is too far ahead
    learning,  ///< the tree still improves: this is an upper bound
    firm,
};

/// Samples and time still needed to reach an error.
struct ErrorForecast {
    double relative_error = 0;
    double spp = 0;      ///< infinite: unknown
    double seconds = 0;  ///< wall-clock seconds; infinite: unknown
    Trust trust = Trust::none;
};

/// Forecast for a render by budget.error: passes double while they teach, then one that does not teach.
ErrorForecast forecast_error(const RenderHistory& state, const Resolved& job, double relative_error);

}  // namespace treefarm
