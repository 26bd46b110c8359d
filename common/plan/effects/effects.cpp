// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/effects.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/config/effects/table.h"
#include "common/config/estimators.h"
#include "common/plan/effects/effect_finder.h"

namespace treefarm {
namespace {

/// Marks an effect as switched off, with the location where the scene uses it.
void tell_forced_off(Effect& after, const Effect& before, const std::vector<Approximation>& approximations) {
    if (!before.on || after.on || approximations.empty()) return;
    std::string by;
    for (const Approximation& approximation : approximations) {
        if (approximation.effect == after.name) {
            by = approximation.effect;
            break;
        }
        by += (by.empty() ? "" : ", effects.") + approximation.effect;
    }
    after.reason = "forced off by effects." + by + " = false; without that: " + before.reason;
    after.where = before.where;
}

/// Throws InputError for a film with negative weights and a job that splats, since splats are sums of values that
/// cannot be negative.
void refuse_signed_splats(const Film& film, const Job& job) {
    if (!estimator_of(job.integrator.type).splats() || !film.is_signed()) return;
    throw InputError(
        Location{"integrator.type", 0, 0},
        "the film's filter has negative lobes, and the estimator \"" + job.integrator.type +
            "\" adds up light that is never negative",
        std::string("use the filter box, tent or gaussian, or set integrator.type = \"") + estimators()[0].type + "\"");
}

/// Light of the scene that the job's estimator never finds.
std::vector<std::string> missed_light(const EffectPlan& plan) {
    const Estimator& estimator = estimator_of(plan.job.integrator.type);
    const auto is_on = [&](const char* name) {
        const Effect* effect = plan.find(name);
        return effect && effect->on;
    };
    std::vector<std::string> misses;
    if (estimator.misses) misses.emplace_back(estimator.misses);
    if (estimator.misses_of_points && is_on("delta_lights") && is_on("delta_reflection"))
        misses.emplace_back(estimator.misses_of_points);
    return misses;
}

}  // namespace

std::vector<Effect> find_effects(const Scene& scene, const Resolved& job) {
    const EffectFinder finder(scene, job);
    std::vector<Effect> effects;
    for_each_effect([&](const auto& row) {
        Effect effect = finder.find(row);
        effect.name = row.text.name;
        effect.group = row.text.group;
        if (!effect.on) effect.bytes = 0;
        effects.push_back(std::move(effect));
    });
    return effects;
}

const Effect* EffectPlan::find(const std::string& name) const {
    const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == name; });
    return found == effects.end() ? nullptr : &*found;
}

EffectPlan plan_effects(Scene& scene, const Job& asked_job) {
    EffectPlan plan;
    refuse_signed_splats(scene.film, asked_job);
    const std::vector<Effect> asked = find_effects(scene, resolve(asked_job, scene));
    plan.approximations = switch_effects_off(scene, asked_job);
    plan.job = resolve(asked_job, scene);
    const Resolved& job = plan.job;
    plan.effects = find_effects(scene, job);
    for (std::size_t i = 0; i < asked.size(); ++i)
        tell_forced_off(plan.effects[i], asked[i], plan.approximations);
    plan.misses = missed_light(plan);
    const std::vector<PassPlan> passes = plan_passes(job);
    plan.width = scene.film.width;
    plan.height = scene.film.height;
    plan.spp = passes.back().first_sample + passes.back().spp;
    plan.pass_count = passes.size();
    plan.passes_guessed = has_open_budget(job);
    plan.triangles = scene.triangle_count();
    plan.kernels = kernels_of(job);
    plan.memory = expected_memory(scene, job);
    return plan;
}

}  // namespace treefarm
