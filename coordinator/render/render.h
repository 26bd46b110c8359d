// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>

#include "coordinator/render/render_observer.h"
#include "coordinator/render/render_request.h"
#include "coordinator/run/run_report.h"

namespace treefarm {

/// How a render came out.
struct RenderOutcome {
    RunState state = RunState::failed;
    std::string error;             ///< why it failed; "" if it did not
    bool missed_target = false;    ///< done, but the error is above budget.error
    bool resumable = false;        ///< the run directory holds a checkpoint
    std::filesystem::path folder;  ///< the run directory
    RenderResult result;           ///< image, its error, and the reports of the finished passes
    std::set<int> left_peers;      ///< workers that left in order
    std::set<int> lost_peers;      ///< workers lost in this job or an earlier one that are not back
};

/// Renders a request to its end: run directory, workers, passes, files. What goes wrong after the run directory exists
/// is logged and summarised there, and is part of the outcome; what is wrong with the request throws InputError, and
/// leaves the folder as it was.
RenderOutcome render(const RenderRequest& request, const RenderObserver& observer = {});

}  // namespace treefarm
