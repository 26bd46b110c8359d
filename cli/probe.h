// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/run/render_run.h"

namespace treefarm {

/// Default length of a probe, in seconds of rendering.
inline constexpr double kProbeSeconds = 5;

/// First passes of a render on this machine.
struct Probe {
    RenderHistory state;    ///< state after them
    bool complete = false;  ///< they are all passes of the job
    bool interrupted = false;
    unsigned threads = 0;
};

/// Renders the first passes in this process, as many as `seconds` allow (a few more if these are not informative),
/// without writing files or keeping an image. `threads`: 0: its processors. Throws RunError.
Probe run_probe(const RenderRequest& request, double seconds, unsigned threads);

}  // namespace treefarm
