// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/retrace_films.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"

namespace treefarm {

namespace {

/// Plans of the passes to trace. A film that several passes were merged into needs them all: merging depends on them.
std::vector<PassPlan> passes_to_trace(const RenderState& state, const std::set<std::string>& lost) {
    std::uint32_t spp = 0;
    for (const PassResult& film : state.films)
        if (lost.contains(film.stored))
            spp = std::max(spp, film.parts.empty() ? film.spp_before + film.spp : state.spp());
    std::vector<PassPlan> plans;
    for (const PassReport& report : state.reports)
        if (report.plan.first_sample < spp) plans.push_back(report.plan);
    return plans;
}

/// Moves a film's pixels from the traced films. Its file is written anew.
void restore(PassResult& film, std::vector<PassResult>& traced) {
    for (PassResult& candidate : traced)
        if (candidate.spp == film.spp && candidate.spp_before == film.spp_before &&
            film_name(encode_pixels(candidate.pixels)) == film.stored) {
            film.pixels = std::move(candidate.pixels);
            film.stored.clear();
            return;
        }
    throw RunError("the checkpoint's film " + film.stored +
                   " is damaged, and its passes, traced again, have other bits");
}

}  // namespace

bool retrace_films(Farm& farm, const RenderRequest& request, RenderState& state, PassHooks hooks) {
    const std::set<std::string>& lost = request.start.checkpoint->lost_films;
    if (lost.empty()) return true;
    RenderState traced;
    hooks.on_last_state = [&](RenderState last) { traced = std::move(last); };
    const Film& film = request.content.scene.film;
    const RenderResult result = run_passes(farm, request.content.plan.job, listed_passes(passes_to_trace(state, lost)),
                                           starting_state(request), film.width, film.height, hooks);
    if (result.interrupted) return false;
    for (PassResult& damaged : state.films)
        if (lost.contains(damaged.stored)) restore(damaged, traced.films);
    return true;
}

}  // namespace treefarm
