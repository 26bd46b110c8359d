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

/// Progress of a render.
struct RenderProgress {
    std::uint32_t pass = 0;
    std::size_t pass_count = 0;   ///< 0: unknown yet
    std::uint32_t spp_done = 0;   ///< in finished passes
    std::uint32_t spp_total = 0;  ///< expected at the end; 0: unknown yet
    double fraction = 0;          ///< of all samples; 0: unknown yet
    ErrorEstimate error;          ///< after the last finished pass
    std::size_t workers = 0;
    std::uint64_t units = 0;  ///< of the pass, that are finished
    std::uint64_t rays = 0;   ///< so far
    double run_seconds = 0;   ///< since the first worker requested units
    ErrorForecast target;     ///< until budget.error, forecast at target_since
    double target_since = 0;  ///< end of the last finished pass, in run_seconds
};

struct RenderResult;

/// Callbacks of the pass loop. Any of them may be empty.
struct PassHooks {
    std::function<bool()> interrupted;  ///< polled often; true ends the render after the last whole pass
    std::function<void(const RenderProgress&)> on_progress;  ///< called often
    std::function<void()> on_collected;  ///< all results of a pass are in: it is combined and learned from next
    /// Called after each pass, with the image so far.
    std::function<void(const PassReport&, const CombinedImage&)> on_pass;
    std::function<void(const RenderResult&)> on_result;        ///< called after on_pass, with all results so far
    std::function<void(const RenderResult&)> on_interruption;  ///< called at once, before anything that takes time
    /// receives the finished passes, before the exception leaves
    std::function<void(RenderResult)> on_failure;
    /// Called last after each pass, with all that a resume needs; also within a pass if state_due.
    std::function<void(RenderState&)> on_state;
    std::function<bool()> state_due;  ///< polled often within a pass
    /// called once at the end with the state, if any pass was finished
    std::function<void(RenderState)> on_last_state;
};

/// Result of a render; after an interruption that of the finished passes, possibly none. The image is empty without a
/// finished pass; each pass makes a new one, so that a caller may keep it without a copy.
struct RenderResult : DevelopedState {
    int width = 0, height = 0;
    std::uint32_t spp = 0;
    bool interrupted = false;
    std::vector<PassReport> passes;
    AnyModel tree;  ///< guide of the pass after the last finished one, or of the last pass; set at the end
    std::uint64_t tree_hash = 0;  ///< of the encoded tree that guided the last pass
};

/// Renders the passes that `choose` returns, one after the other, from `state` on: broadcasts the tree, issues the
/// units, collects film and sums, refines. Resumes a state with finished passes.
RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, RenderState state, int width,
                        int height, const PassHooks& hooks);

/// Renders the passes that `choose` returns, from the first one, which `tree` guides.
RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, AnyModel tree, int width,
                        int height, const PassHooks& hooks);

}  // namespace treefarm
