// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/run/render_series.h"

namespace treefarm {

/// The frames of a shot.
struct Shot {
    std::filesystem::path directory;                 ///< where they go
    std::vector<int> frames;                         ///< in the order in which they are rendered
    std::function<RenderRequest(int)> read_request;  ///< reads a frame's job and scene; throws InputError
    /// What a request can go on from in the folder of a frame that was broken off; nullptr: nothing.
    std::function<std::shared_ptr<LoadedCheckpoint>(const std::filesystem::path&, const RenderRequest&)>
        find_checkpoint;
};

struct ShotOutcome {
    RunState state = RunState::failed;  ///< failed: at least one frame
    bool missed_target = false;         ///< an error of one is above budget.error
    std::set<int> lost_peers;
};

/// Renders the frames that are not there yet, in one allocation of workers, and leaves in the shot's folder:
///   shot.json      how every frame stands
///   frame.0001/    a run directory each
/// A frame that fails stops no other. Throws InputError where the folder cannot be a shot's.
ShotOutcome run_shot(Channel& channel, const Shot& shot, const SeriesContext& context,
                     const std::function<bool()>& interrupted);

}  // namespace treefarm
