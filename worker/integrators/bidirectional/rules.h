// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/techniques.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/subpath/roulette.h"
#include "worker/integrators/subpath/technique_sums.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Settings of bidirectional paths, from job and pass.
struct BidirectionalRules {
    int max_depth;     ///< edges of a path from lamp to lens; -1: no limit
    bool next_event;   ///< emitters are sampled
    bool delta_alone;  ///< only those without extent are sampled
    bool light_image;  ///< light paths are connected to the lens
    bool compare;      ///< samples also report the value of their camera path alone
    bool weighted;     ///< techniques that find the same light are weighted
    bool strict_normals, hide_emitters;
    Heuristic heuristic;
    Roulette roulette;
    TechniqueSet techniques;  ///< techniques that contribute to the image

    BidirectionalRules(const TraceScene& scene, const Resolved& job, const PassPlan& pass)
        : max_depth(job.integrator.max_depth),
          next_event(pass.next_event && scene.emitters().can_sample()),
          delta_alone(!pass.next_event && scene.emitters().has_delta_lights()),
          light_image(job.bidirectional.light_image),
          compare(job.bidirectional.light_subpaths == Rule::while_it_pays),
          weighted(job.bidirectional.weighted),
          strict_normals(job.integrator.strict_normals),
          hide_emitters(job.integrator.hide_emitters),
          heuristic(job.integrator.mis),
          roulette(Roulette::Rule::unguided, job.integrator.rr_depth),
          techniques(job.bidirectional.techniques) {}

    /// Whether a path of `edges` edges may continue.
    bool goes_on(int edges) const { return max_depth < 0 || edges < max_depth; }
    /// Weight of a technique; `others`: sum of the other techniques relative to it.
    double weight(double others) const { return weighted ? technique_weight(others) : 1.0; }
};

}  // namespace treefarm
