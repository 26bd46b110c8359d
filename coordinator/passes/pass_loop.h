// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/combine.h"
#include "common/guiding/any_guide.h"
#include "common/plan/forecast/budget.h"
#include "common/scene/model/scene.h"
#include "coordinator/farm/farm.h"
#include "coordinator/passes/pass_report.h"
#include "coordinator/passes/render_state.h"

namespace treefarm {

/// How far a render is.
struct RenderProgress {
    std::uint32_t pass = 0;
    std::size_t pass_count = 0;   ///< 0: not known yet
    std::uint32_t spp_done = 0;   ///< in finished passes
    std::uint32_t spp_total = 0;  ///< expected at the end; 0: not known yet
    double fraction = 0;          ///< of all samples; 0: not known yet
    ErrorEstimate error;          ///< after the last finished pass
    std::size_t workers = 0;
    std::uint64_t rays = 0;   ///< so far
    double run_seconds = 0;   ///< since the first worker asked for work
    ErrorForecast target;     ///< until budget.error, as it was at target_since
    double target_since = 0;  ///< end of the last finished pass, in run_seconds
};

struct RenderResult;

/// Functions that the pass loop calls. Any of them may be empty.
struct PassHooks {
    std::function<bool()> interrupted;  ///< asked often; true ends the render after the last whole pass
    std::function<void(const RenderProgress&)> on_progress;  ///< called often
    std::function<void()> on_collected;  ///< a pass has come in whole: now it is combined and learned from
    /// Called after each pass, with the image so far.
    std::function<void(const PassReport&, const CombinedImage&)> on_pass;
    std::function<void(const RenderResult&)> on_result;        ///< called after on_pass, with all there is so far
    std::function<void(const RenderResult&)> on_interruption;  ///< at once: what takes time comes later
    std::function<void(RenderResult)> on_failure;              ///< the finished passes, before the error leaves
    /// Called last after each pass, with all that a render needs that goes on from here; within one where that is due.
    std::function<void(RenderState&)> on_state;
    std::function<bool()> state_due;                 ///< asked often within a pass
    std::function<void(RenderState)> on_last_state;  ///< once at the end, if any pass was finished: it gets the state
};

/// Result of a render; after an interruption of the passes that were whole by then, possibly none. The image is empty
/// if no pass was finished; each pass makes a new one, so who keeps one needs no copy.
struct RenderResult : DevelopedState {
    int width = 0, height = 0;
    std::uint32_t spp = 0;
    bool interrupted = false;
    std::vector<PassReport> passes;
    AnyModel tree;  ///< that guides the pass after the last finished one, or guided the last of all; set at
                    ///< the end
    std::uint64_t tree_hash = 0;  ///< of the encoded tree that guided the last pass
};

/// Renders the passes that `choose` says, one after the other, from `state` on: broadcast the tree, hand out the work,
/// collect film and sums, refine. A state of finished passes goes on where it was.
RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, RenderState state, int width,
                        int height, const PassHooks& hooks);

/// Renders the passes that `choose` says from the first on, which `tree` guides.
RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, AnyModel tree, int width,
                        int height, const PassHooks& hooks);

}  // namespace treefarm
