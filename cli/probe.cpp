// SPDX-License-Identifier: Apache-2.0
#include "cli/probe.h"

#include <algorithm>

#include "cli/on_farm.h"
#include "common/plan/learning.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/pass_loop.h"

namespace treefarm {

namespace {

/// Fewer samples tell neither an interval of the error nor what a tree brings; but they are not waited for longer than
/// so many seconds.
constexpr std::uint32_t kLeastSpp = 31;
constexpr double kPatienceSeconds = 30;

/// Whether the probe should end here rather than with another pass.
bool is_enough(const RenderHistory& state, const PassPlan& next, double limit) {
    if (state.passes.empty()) return false;
    const PassFacts& last = state.passes.back();
    const double coming = state.seconds + last.overhead_seconds + last.collect_seconds / last.spp * next.spp;
    return coming > (state.spp() < kLeastSpp ? std::max(limit, kPatienceSeconds) : limit);
}

}  // namespace

Probe run_probe(const RenderRequest& request, double seconds, unsigned threads) {
    Probe probe;
    probe.threads = threads > 0 ? threads : affinity_threads();
    const Film& film = request.scene.film;
    FarmTask task;
    task.prepare = [] {};
    task.coordinate = [&](Channel& channel, const std::function<bool()>& interrupted) -> CoordinatorEnd {
        const Log log = make_log("treefarm", {}, request.console, Verbosity::quiet);
        Farm farm(channel, request.plan.job, encode_scene(request.scene), request.fingerprint.hash(), log);
        farm.gather(interrupted);
        farm.allow_negative(film.is_signed());
        const PassChooser own = passes_of(request.plan.job);
        const PassChooser first = [&](const RenderHistory& state) {
            probe.state = state;
            NextPass next = own(state);
            probe.complete = !next.pass;
            if (next.pass && is_enough(state, *next.pass, seconds)) next.pass.reset();
            return next;
        };
        PassHooks hooks;
        hooks.interrupted = interrupted;
        probe.interrupted = run_passes(farm, request.plan.job, first, first_model(request.plan.job, request.scene),
                                       film.width, film.height, hooks)
                                .interrupted;
        return {0, farm.lost_peers()};
    };
    run_on_farm(LaunchEnvironment{}, {.threads = threads}, {request.console, Verbosity::quiet}, task);
    return probe;
}

}  // namespace treefarm
