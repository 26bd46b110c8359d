// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/render/render_series.h"

namespace treefarm {

/// Frames of a shot.
struct Shot {
    std::filesystem::path directory;                 ///< folder of their run directories
    std::vector<int> frames;                         ///< in the order in which they are rendered
    std::function<RenderRequest(int)> read_request;  ///< reads a frame's job and scene; throws InputError
};

struct ShotOutcome {
    RunState state = RunState::failed;  ///< failed: at least one frame failed
    bool missed_target = false;         ///< at least one error is above budget.error
    std::set<int> lost_peers;
};

/// Renders the frames that are not there yet, in one allocation of workers, and leaves in the shot's folder:
///   shot.json      how every frame stands
///   frame.0001/    a run directory each
/// A frame that fails stops no other. Throws InputError where the folder cannot be a shot's.
ShotOutcome run_shot(const Shot& shot, const SeriesContext& context);

}  // namespace treefarm
