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
    std::string error;             ///< why it failed; "" if it did not
    bool missed_target = false;    ///< done, but the error is above budget.error
    bool resumable = false;        ///< the run directory holds a checkpoint
    std::filesystem::path folder;  ///< the run directory
    RenderResult result;           ///< image, its error, and the reports of the finished passes
    std::set<int> left_peers;      ///< workers that left in order
    std::set<int> lost_peers;      ///< workers that were given up, now or in an earlier job, and are not back
};

/// Renders a request: run directory, workers, passes, files. A request that cannot be rendered throws InputError, and
/// the folder is left as it was. Later failures are logged and summarised in the run directory, and are part of the
/// outcome.
RenderOutcome render(const RenderRequest& request, const RenderObserver& observer = {});

}  // namespace treefarm
