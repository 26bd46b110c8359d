// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/region_sampler.h"
#include "common/math/next_event_sums.h"
#include "common/plan/policy.h"
#include "common/plan/resolve.h"
#include "common/plan/schedule.h"
#include "worker/integrators/subpath/roulette.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Whether a pass counts what next event brings, for whoever decides how often it samples emitters.
inline bool counts_next_event(const Resolved& job, const PassPlan& pass, const RegionSampler& guide) {
    return pass.next_event && job.decides_next_event && guide.knows_image() &&
           (!pass.record || guide.decides_next_event()) &&
           multiples_in(pass.first_sample, pass.spp, kPolicy.next_event.counted_every) > 0;
}

/// Settings of the walk besides the scene: fixed for a pass.
struct PathSettings {
    int max_depth;
    bool next_event;          ///< a flag, not a kernel of its own: one predictable branch per vertex
    bool delta_alone;         ///< no next event, but for the lights that nothing else finds
    float light_samples;      ///< at each vertex; 0: as the guide says
    bool thin_next_event;     ///< some vertices have fewer light samples than one
    bool few_light_samples;   ///< so few that vertices which have one draw its numbers alone
    bool count_next_event;    ///< for whoever decides how many
    bool estimates_unguided;  ///< guided paths tell what unguided ones would be like
    bool delta_lights;        ///< among others: they are sampled always
    MisHeuristic mis;
    bool strict_normals;
    bool hide_emitters;
    bool split_glass;           ///< glass_splits.h
    bool record_light_samples;  ///< kick-start: what next event finds teaches the tree, too
    bool profile;
    bool textured;             ///< surfaces have something to look up
    bool jitter_records;       ///< stochastic spatial filter
    std::uint32_t candidates;  ///< directions drawn at a guided vertex, of which one is taken (candidates.h)
    int candidate_depth;       ///< up to here; deeper vertices draw one
    std::uint32_t splitting;   ///< as how many paths one may go on at a vertex
    bool compare_splitting;    ///< with what paths would be alone
    GuidingTarget target;
    ViewRecords view_records;
    float bootstrap;  ///< RecordRules::bootstrap
    Roulette roulette, unguided_roulette;

    /// Whether vertices look up their region: the number of light samples is then the region's.
    static bool by_region(const PassPlan& pass) { return pass.guided || pass.record; }

    /// Drawing one vertex's numbers alone takes some three times as long as among many.
    static constexpr float kFew = 1.0f / 3;

    PathSettings(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const RegionSampler& guide)
        : max_depth(job.integrator.max_depth),
          next_event(pass.next_event && scene.emitters().can_sample()),
          delta_alone(!pass.next_event && scene.emitters().has_delta_lights()),
          light_samples(job.integrator.light_samples),
          thin_next_event(next_event &&
                          (light_samples > 0.0f ? light_samples < 1.0f : guide.thins_next_event(by_region(pass)))),
          few_light_samples(thin_next_event && !by_region(pass) && !scene.emitters().has_delta_lights() &&
                            (light_samples > 0.0f ? light_samples : guide.image_next_event()) < kFew),
          count_next_event(next_event && counts_next_event(job, pass, guide)),
          estimates_unguided(pass.guided && pass.record && guide.trained() && guide.knows_image() &&
                             job.guiding.rule == Rule::while_it_pays),
          delta_lights(scene.emitters().has_delta_lights()),
          mis(job.integrator.mis),
          strict_normals(job.integrator.strict_normals),
          hide_emitters(job.integrator.hide_emitters),
          split_glass(job.integrator.split_glass),
          record_light_samples(job.integrator.next_event == NextEvent::kickstart && pass.next_event),
          profile(job.farm.profile),
          textured(!scene.plainly_diffuse() && scene.materials().varies()),
          jitter_records(job.guiding.spatial_filter == SpatialFilter::stochastic),
          candidates(static_cast<std::uint32_t>(job.guiding.candidates)),
          candidate_depth(job.guiding.candidate_depth),
          splitting(pass.split ? static_cast<std::uint32_t>(job.guiding.splitting) : 1u),
          compare_splitting(pass.record && splitting > 1),
          target(job.guiding.target),
          view_records(job.guiding.view_records),
          bootstrap(job.guiding.bootstrap),
          roulette(!pass.guided                                       ? Roulette::Rule::unguided
                   : !guide.trained()                                 ? Roulette::Rule::untrained
                   : job.guiding.roulette == GuidingRoulette::adjoint ? Roulette::Rule::adjoint
                                                                      : Roulette::Rule::constant,
                   job.integrator.rr_depth),
          unguided_roulette(Roulette::Rule::unguided, job.integrator.rr_depth) {}
};

}  // namespace treefarm
