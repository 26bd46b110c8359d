// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve/resolve.h"

#include <algorithm>
#include <cmath>

#include "common/base/policy.h"
#include "common/config/estimators.h"
#include "common/config/job_keys.h"
#include "common/decide/splitting/splitting_constants.h"
#include "common/plan/resolve/splat_quantum.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"

namespace treefarm {
namespace {

bool chooses_lights(const Scene& scene) {
    bool with_image = false;
    for (const Emitter& emitter : scene.emitters)
        for_each_image(emitter, [&](std::int32_t) { with_image = true; });
    return with_image || scene.emitters.size() > 1;
}

/// Factor c of the spatial split rule, proportional to the fourth root of the film's pixels: more pixels bring more
/// records, but the amount to be learned grows more slowly.
double usual_spatial_threshold(double film_pixels) {
    return tuned("learning.spatial_threshold") * std::sqrt(std::sqrt(film_pixels / (512.0 * 512.0)));
}

void resolve_rules(Job::Guiding& guiding) {
    if (guiding.rule == Rule::usual)
        guiding.rule = guiding.type == GuidingType::automatic ? Rule::while_it_pays : Rule::always;
    if (guiding.type == GuidingType::automatic) guiding.type = GuidingType::view;
    if (guiding.splitting_rule == Rule::usual)
        guiding.splitting_rule = guiding.splitting == 0 ? Rule::while_it_pays : Rule::always;
}

/// Whether finished passes may decide on next event. Published methods had no such decision; it holds for the balance
/// heuristic with one direction and light samples; and weights fixed in advance require passes fixed in advance.
bool may_decide_next_event(const Job& job) {
    return estimator_of(job.integrator.type).guides && job.integrator.light_samples == 0 &&
           job.guiding.preset.empty() && !job.budget.strict && job.integrator.mis == MisHeuristic::balance &&
           job.guiding.candidates == 1 && job.guiding.target == GuidingTarget::radiance &&
           job.guiding.combination == Combination::inverse_variance;
}

/// Whether the scene has light that only paths from emitters find: emitters without extent, seen by way of mirrors or
/// smooth glass.
bool lights_alone_find(const Scene& scene) {
    const bool has_points = std::any_of(scene.emitters.begin(), scene.emitters.end(), [](const Emitter& emitter) {
        return std::visit([]<class Kind>(const Kind&) { return Kind::kTraits.type == LightType::delta; }, emitter.kind);
    });
    return has_points && scene_traits(scene).lobes.delta_reflection;
}

/// Keeps light subpaths if their contributions are requested, or cannot be obtained otherwise.
void resolve_light_subpaths(Job::Bidirectional& bidirectional, const SceneFacts& scene) {
    if (bidirectional.techniques != "all" || !bidirectional.weighted || scene.lights_alone_find)
        bidirectional.light_subpaths = Rule::always;
    else if (bidirectional.light_subpaths == Rule::usual)
        bidirectional.light_subpaths = Rule::while_it_pays;
}

/// Resets the settings that the job's estimator does not use.
void resolve_estimator(Job& job) {
    const Estimator& estimator = estimator_of(job.integrator.type);
    if (estimator.guides) return;
    job.guiding.type = GuidingType::none;
    job.guiding.splitting = job.guiding.candidates = 1;
    job.integrator.light_samples = 0;
    job.integrator.split_glass = false;
    if (!estimator.sees_light || !estimator.has_camera_paths()) job.integrator.next_event = NextEvent::never;
    if (estimator.by_numbers)
        job.integrator.next_event = job.integrator.emitter_samples > 0 ? NextEvent::always : NextEvent::never;
    if (estimator.depth == 0) return;
    const int asked = job.integrator.max_depth;
    job.integrator.max_depth = asked < 0 ? estimator.depth : std::min(asked, estimator.depth);
    job.integrator.rr_depth = std::max(job.integrator.rr_depth, job.integrator.max_depth);
}

float ao_reach(const Scene& scene) {
    const Box3 box = scene.bounds();
    if (box.isEmpty()) return SceneFacts().ao_reach;
    const Imath::V3d diagonal = Imath::V3d(box.max) - Imath::V3d(box.min);
    return static_cast<float>(0.25 * std::sqrt(diagonal.dot(diagonal)));
}

}  // namespace

SceneFacts facts_of(const Scene& scene) {
    return {scene.film.whole_width(),
            scene.film.whole_height(),
            scene.film.pixel_count(),
            is_plainly_diffuse(scene),
            scene_traits(scene).lobes.view_dependent(),
            chooses_lights(scene),
            usual_splat_exponent(scene),
            ao_reach(scene),
            lights_alone_find(scene)};
}

Resolved resolve(const Job& job, const SceneFacts& scene) {
    Resolved resolved{job, scene};
    Job::Guiding& guiding = resolved.guiding;
    resolved.image = {scene.whole_width, scene.whole_height};
    resolve_estimator(resolved);
    resolve_rules(guiding);
    NextEvent& next_event = resolved.integrator.next_event;
    if (next_event == NextEvent::automatic || next_event == NextEvent::while_it_pays)
        next_event = may_decide_next_event(resolved) ? NextEvent::while_it_pays : NextEvent::always;
    resolved.decides_next_event = next_event == NextEvent::while_it_pays;
    resolve_light_subpaths(resolved.bidirectional, scene);
    if (resolved.integrator.ao_distance == 0) resolved.integrator.ao_distance = scene.ao_reach;
    const bool by_view = guiding.type == GuidingType::view;
    if (guiding.splitting == 0)
        guiding.splitting = by_view && guiding.roulette == GuidingRoulette::adjoint
                                ? tuned<policy::kSplitting, int>("splitting.usual")
                                : 1;
    const bool table = guiding.type == GuidingType::qtable;
    if (guiding.grid_halvings == 0)
        guiding.grid_halvings = table ? 15 : 12;  // cells of a table learn means, which need fewer records
    if (guiding.bootstrap == kUsualBootstrap) guiding.bootstrap = table ? 1.0f : 0.0f;
    if (guiding.spatial_threshold == 0)
        guiding.spatial_threshold = usual_spatial_threshold(static_cast<double>(scene.film_pixels));
    // The compression that packs best: noisy floats hardly shrink (packed_by in image/exr_write.cpp).
    if (resolved.output.compression == "auto") resolved.output.compression = resolved.output.half ? "zip" : "rle";
    resolved.guides = guiding.type != GuidingType::none;
    resolved.learns_views = by_view && scene.view_dependent;
    LightSelection& lights = resolved.integrator.light_selection;
    resolved.learns_lights = resolved.guides && lights == LightSelection::learned &&
                             resolved.integrator.next_event != NextEvent::never && scene.chooses_lights;
    resolved.learns_emission =
        estimator_of(job.integrator.type).splats() && lights == LightSelection::learned && scene.chooses_lights;
    if (lights == LightSelection::learned && !resolved.learns_lights && !resolved.learns_emission)
        lights = LightSelection::tree;
    resolved.cells_follow_use = by_view && guiding.view_records == ViewRecords::product && guiding.learn_bsdf_fraction;
    return resolved;
}

Resolved resolve(const Job& job, const Scene& scene) {
    return resolve(job, facts_of(scene));
}

DecisionRules decision_rules(const Resolved& job) {
    return {.guiding = job.guiding.rule == Rule::while_it_pays,
            .splitting = job.guiding.splitting_rule == Rule::while_it_pays,
            .next_event = job.decides_next_event,
            .light_subpaths = job.bidirectional.light_subpaths == Rule::while_it_pays};
}

std::string guiding_word(const Resolved& job) {
    Job asked = job;
    if (job.guiding.type == GuidingType::view && job.guiding.rule == Rule::while_it_pays)
        asked.guiding.type = GuidingType::automatic;
    return find_job_key("guiding.type")->print(asked);
}

}  // namespace treefarm
