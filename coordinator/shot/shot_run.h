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

/// Renders the missing frames within one allocation of workers, and writes to the shot's folder:
///   shot.json      state of every frame
///   frame.0001/    run directory of a frame
/// A failing frame stops no other. Throws InputError if the folder has other content.
ShotOutcome run_shot(const Shot& shot, const SeriesContext& context);

}  // namespace treefarm
