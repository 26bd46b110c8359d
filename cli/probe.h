// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/run/render_run.h"

namespace treefarm {

/// How long a probe usually takes, seconds of rendering.
inline constexpr double kProbeSeconds = 5;

/// The first passes of a render, on this machine.
struct Probe {
    RenderHistory state;    ///< after them
    bool complete = false;  ///< they are all that the job asks for
    bool interrupted = false;
    unsigned threads = 0;
};

/// Renders the first passes in this process, as many as fit into so many seconds (a few more where they would tell
/// nothing), writes nothing and keeps no image. `threads`: 0: its processors. Throws RunError.
Probe run_probe(const RenderRequest& request, double seconds, unsigned threads);

}  // namespace treefarm
