// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/passes_alone.h"

#include <algorithm>
#include <utility>

#include "common/plan/schedule/kernel.h"
#include "common/scene/pack/scene_codec.h"

namespace treefarm {

namespace {

/// Whether a checkpoint's passes begin these ones; kernels are ignored, since later ones may be unknown.
bool begins(const std::vector<PassPlan>& plans, const RenderState& state) {
    const auto alike = [](const PassReport& done, PassPlan plan) {
        plan.kernel = done.plan.kernel;
        return done.plan == plan;
    };
    return state.reports.size() <= plans.size() &&
           std::equal(state.reports.begin(), state.reports.end(), plans.begin(), alike);
}

/// State before the sample's pass, as far as a checkpoint has it; otherwise the state before any pass.
RenderState nearest_state(const RenderRequest& request, const std::vector<PassPlan>& plans, std::uint32_t pass) {
    if (request.start.checkpoint && request.start.checkpoint->lost_films.empty() &&
        begins(plans, request.start.checkpoint->state)) {
        RenderState& state = request.start.checkpoint->state;
        // Unless the pass taught it something: an unguided pass may decide on next event.
        const PassPlan* const last = state.reports.empty() ? nullptr : &state.reports.back().plan;
        const bool has_its_tree = last && state.reports.size() == pass + 1 && !last->record &&
                                  (last->guided || !request.content.plan.job.decides_next_event);
        if (state.reports.size() <= pass || has_its_tree) return std::move(state);
    }
    return starting_state(request);
}

/// Model of a pass, learned by rendering the passes before it that the checkpoint lacks; it may only decide on next
/// event.
AnyModel learn_model(const RenderRequest& request, const std::vector<PassPlan>& plans, std::uint32_t pass,
                     const TellMessage& tell) {
    RenderState state = nearest_state(request, plans, pass);
    const bool learns = request.content.plan.job.guides || request.content.plan.job.decides_next_event;
    if (state.reports.size() >= pass || !learns) return std::move(state.tree);
    bool enough = false;
    PassHooks hooks;
    hooks.interrupted = [&] { return enough; };
    hooks.on_pass = [&](const PassReport& report, const CombinedImage&) { enough = report.plan.index + 1 == pass; };
    return render_without_files(request, listed_passes(plans), std::move(state), hooks, tell).tree;
}

}  // namespace

RenderResult render_without_files(const RenderRequest& request, const PassChooser& passes, RenderState state,
                                  const PassHooks& hooks, const TellMessage& tell) {
    const Resolved& job = request.content.plan.job;
    const Film& film = request.content.scene.film;
    LocalFarm here(request.workers.local);
    Farm farm(here.channel(), job, encode_scene(request.content.scene), request.origin.fingerprint.hash(),
              make_log("treefarm", {}, tell));
    farm.gather(request.workers.stop);
    farm.allow_negative(film.is_signed());
    return run_passes(farm, job, passes, std::move(state), film.width, film.height, hooks);
}

std::vector<PassPlan> known_passes(const RenderRequest& request) {
    const RenderContent& content = request.content;
    if (!content.schedule.empty()) return content.schedule;
    return has_open_budget(content.plan.job) ? std::vector<PassPlan>() : plan_passes(content.plan.job);
}

std::pair<AnyModel, PassPlan> model_and_pass(const RenderRequest& request, const std::vector<PassPlan>& plans,
                                             std::uint32_t index, const TellMessage& tell) {
    AnyModel model = learn_model(request, plans, index, tell);
    PassPlan pass = plans[index];
    pass.kernel = kernel_of(request.content.plan.job, pass, facts_of(model));
    return {std::move(model), pass};
}

}  // namespace treefarm
