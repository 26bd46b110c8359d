// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/forecast/outlook.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// An expected figure with its likely range.
struct Expected {
    double value = 0, low = 0, high = 0;
};

/// Expected cost and error of a render, from its finished passes.
struct Expectation {
    bool known = false;
    bool reached = false;   ///< the finished passes suffice
    std::string unknown;    ///< reason why it is unknown
    Expected spp, seconds;  ///< totals of the render
    Expected error;         ///< rmse / mean luminance
};

/// Expectation for a render that stops at `relative_error`.
Expectation expect_error(const RenderHistory& state, const Resolved& job, double relative_error);

/// Expectation for a render of so many seconds.
Expectation expect_after_seconds(const RenderHistory& state, const Resolved& job, double seconds);

/// Expectation for a render of so many samples per pixel.
Expectation expect_after_spp(const RenderHistory& state, const Resolved& job, double spp);

}  // namespace treefarm
