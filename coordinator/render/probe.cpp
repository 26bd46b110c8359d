// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/probe.h"

#include <algorithm>
#include <utility>

#include "common/plan/schedule/learning.h"
#include "coordinator/render/passes_alone.h"

namespace treefarm {

namespace {

/// Least samples of a probe, for an interval of the error and the effect of a tree; kPatienceSeconds limits the time
/// for them.
constexpr std::uint32_t kLeastSpp = 31;
constexpr double kPatienceSeconds = 30;

/// Whether the probe should end before another pass.
bool is_enough(const RenderHistory& state, const PassPlan& next, double limit) {
    if (state.passes.empty()) return false;
    const PassFacts& last = state.passes.back();
    const double coming = state.seconds + last.overhead_seconds + last.collect_seconds / last.spp * next.spp;
    return coming > (state.spp() < kLeastSpp ? std::max(limit, kPatienceSeconds) : limit);
}

}  // namespace

Probe run_probe(const RenderRequest& request, double seconds, const TellMessage& tell) {
    Probe probe;
    const Resolved& job = request.content.plan.job;
    const PassChooser own = passes_of(job);
    const PassChooser first = [&](const RenderHistory& state) {
        probe.state = state;
        NextPass next = own(state);
        probe.complete = !next.pass;
        if (next.pass && is_enough(state, *next.pass, seconds)) next.pass.reset();
        return next;
    };
    PassHooks hooks;
    hooks.interrupted = request.workers.stop;
    const Film& film = request.content.scene.film;
    RenderState state = first_state(job, first_model(job, request.content.scene), film.pixel_count());
    probe.interrupted = render_without_files(request, first, std::move(state), hooks, tell).interrupted;
    return probe;
}

}  // namespace treefarm
