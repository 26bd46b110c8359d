// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/plan/forecast/outlook.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Whether the image is the passes of the last tree alone: of budget.strict its very last pass.
bool shows_last_tree_only(const Resolved& job);

/// Samples per pixel that one further pass needs until the image's mean squared error is `mse`, if one of its samples
/// has this variance (docs/design/error.md, "error"). 0: it is there already. Infinite: not known yet.
double spp_to_reach(const RenderHistory& state, const Resolved& job, double mse, double variance);

/// How passes that end a render for budget.error are chosen: so much beyond the samples that the error needs, so that
/// few of them suffice; ...
double ending_margin(const Resolved& job);
/// ... and by this variance of a sample, once `trees` more trees were learned. A strict render cannot make up for a
/// tree that brings less than it should: it takes the variance of the tree before.
double ending_variance(const Outlook& outlook, const Resolved& job, int trees);

/// How far a forecast can be trusted.
enum class Trust : std::uint8_t {
    none,      ///< nothing is known yet
    noisy,     ///< the error itself is not known well enough, or it is too far ahead
    learning,  ///< the tree still makes samples less noisy: it takes this at most
    firm,
};

/// Samples and time to come down to an error, beyond what is done.
struct ErrorForecast {
    double relative_error = 0;
    double spp = 0;      ///< infinite: not known
    double seconds = 0;  ///< of the clock; infinite: not known
    Trust trust = Trust::none;
};

/// The render goes on as budget.error has it: passes double while they teach, then one that teaches nothing.
ErrorForecast forecast_error(const RenderHistory& state, const Resolved& job, double relative_error);

}  // namespace treefarm
