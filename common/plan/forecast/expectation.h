// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/forecast/outlook.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// A figure that is expected, and where it is most likely to be found.
struct Expected {
    double value = 0, low = 0, high = 0;
};

/// Cost and error of a render in the end, as expected by the passes that are done.
struct Expectation {
    bool known = false;
    bool reached = false;   ///< by those passes: nothing more is needed
    std::string unknown;    ///< why it is not known
    Expected spp, seconds;  ///< in all
    Expected error;         ///< rmse / mean luminance
};

/// Expectation of a render that goes on until the error is `relative_error`.
Expectation expect_error(const RenderHistory& state, const Resolved& job, double relative_error);

/// Expectation of a render after so many seconds.
Expectation expect_after_seconds(const RenderHistory& state, const Resolved& job, double seconds);

/// Expectation of a render after so many samples per pixel.
Expectation expect_after_spp(const RenderHistory& state, const Resolved& job, double spp);

}  // namespace treefarm
