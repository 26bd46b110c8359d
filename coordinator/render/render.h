// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>

#include "coordinator/render/render_observer.h"
#include "coordinator/render/render_request.h"
#include "coordinator/run/run_report.h"

namespace treefarm {

/// Outcome of a render.
struct RenderOutcome {
    RunState state = RunState::failed;
    std::string error;             ///< reason of the failure; "" without one
    bool missed_target = false;    ///< done, but the error is above budget.error
    bool resumable = false;        ///< the run directory holds a checkpoint
    std::filesystem::path folder;  ///< the run directory
    RenderResult result;           ///< image, its error, and the reports of the finished passes
    std::set<int> left_peers;      ///< workers that left in order
    std::set<int> lost_peers;      ///< workers lost in this job or an earlier one that are not back
};

/// Renders a request to its end: run directory, workers, passes, files. An error after the run directory exists is
/// logged and summarised there, and is part of the outcome; an error in the request throws InputError and leaves the
/// folder unchanged.
RenderOutcome render(const RenderRequest& request, const RenderObserver& observer = {});

}  // namespace treefarm
