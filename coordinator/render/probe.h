// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/log.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Default length of a probe, in seconds of rendering.
inline constexpr double kProbeSeconds = 5;

/// First passes of a render.
struct Probe {
    RenderHistory state;    ///< state after them
    bool complete = false;  ///< they are all passes of the job
    bool interrupted = false;
    unsigned threads = 0;  ///< of the worker; to be set by its owner
};

/// Renders the first passes by a worker in this process, as many as `seconds` allow (a few more if these are not
/// informative), without writing files or keeping an image. Throws RunError.
Probe run_probe(const RenderRequest& request, double seconds, const TellMessage& tell = {});

}  // namespace treefarm
