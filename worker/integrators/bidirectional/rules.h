// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/techniques.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/subpath/roulette.h"
#include "worker/integrators/subpath/technique_sums.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// What job and pass say of bidirectional paths.
struct BidirectionalRules {
    int max_depth;     ///< edges of a path from lamp to lens; -1: no limit
    bool next_event;   ///< emitters are sampled
    bool delta_alone;  ///< only those without extent are
    bool light_image;  ///< light paths are connected to the lens
    bool compare;      ///< samples also say what their path from the camera would carry alone
    bool weighted;     ///< techniques share the light that several find
    bool strict_normals, hide_emitters;
    Heuristic heuristic;
    Roulette roulette;
    TechniqueSet techniques;  ///< of which the image is made

    BidirectionalRules(const TraceScene& scene, const Job& job, const PassPlan& pass)
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

    /// Whether a path of so many edges may go on.
    bool goes_on(int edges) const { return max_depth < 0 || edges < max_depth; }
    /// Weight of a technique against the others.
    double weight(double others) const { return weighted ? technique_weight(others) : 1.0; }
};

}  // namespace treefarm
