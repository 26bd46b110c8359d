// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/decide/next_event/next_event_constants.h"
#include "common/decide/next_event/next_event_sums.h"
#include "common/guiding/regions/region_sampler.h"
#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/subpath/roulette.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Whether a pass counts next event's contributions, from which its sampling rate is decided.
inline bool counts_next_event(const Resolved& job, const PassPlan& pass, const RegionSampler& guide) {
    return pass.next_event && job.decides_next_event && guide.knows_image() &&
           (!pass.record || guide.decides_next_event()) &&
           multiples_in(pass.first_sample, pass.spp,
                        tuned<policy::kNextEvent, std::uint32_t>("next_event.counted_every")) > 0;
}

/// Settings of the walk, fixed for a pass.
struct PathSettings {
    int max_depth;
    bool next_event;          ///< a flag rather than a kernel of its own: one predictable branch per vertex
    bool delta_alone;         ///< only lights that nothing else finds are sampled
    float light_samples;      ///< at each vertex; 0: the guide decides
    bool thin_next_event;     ///< some vertices have less than one light sample on average
    bool few_light_samples;   ///< so rare that numbers are drawn per vertex, not per batch
    bool count_next_event;    ///< the pass counts contributions, to decide the sampling rate
    bool estimates_unguided;  ///< guided paths estimate the cost and variance of unguided ones
    bool delta_lights;        ///< there are lights without extent: they are always sampled
    MisHeuristic mis;
    bool strict_normals;
    bool hide_emitters;
    bool split_glass;           ///< glass_splits.h
    bool record_light_samples;  ///< kick-start: next event's samples teach the tree, too
    bool profile;
    bool textured;             ///< some materials have textures
    bool jitter_records;       ///< stochastic spatial filter
    std::uint32_t candidates;  ///< directions drawn at a guided vertex, of which one is taken (candidates.h)
    int candidate_depth;       ///< last depth with several candidates; deeper vertices draw one
    std::uint32_t splitting;   ///< largest number of paths as which one may continue at a vertex
    bool compare_splitting;    ///< paths also report their value without splitting
    GuidingTarget target;
    ViewRecords view_records;
    float bootstrap;  ///< RecordRules::bootstrap
    Roulette roulette, unguided_roulette;

    /// Whether vertices look up their region, which then sets the number of light samples.
    static bool by_region(const PassPlan& pass) { return pass.guided || pass.record; }

    /// Fraction of vertices below which numbers are drawn per vertex: one vertex's numbers alone take three times as
    /// long.
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
