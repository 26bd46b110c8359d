// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/film/combine.h"
#include "common/film/splat_film.h"
#include "common/guiding/any_guide.h"
#include "common/plan/forecast/budget.h"
#include "common/scene/model/scene.h"
#include "coordinator/passes/pass_report.h"
#include "worker/integrators/unit_stats.h"

namespace treefarm::test {

/// All passes of a job in this thread, without a farm: the result that the farm must reproduce bit by bit.
struct LocalRender {
    std::vector<PassResult> passes;
    std::vector<RenderHistory> states;  ///< after each pass; its clock counts a millisecond per sample
    std::vector<PassPlan> plans;
    std::vector<UnitStats> stats;
    std::vector<PassReport> reports;  ///< with each pass's decisions and their evidence
    SplatCaps splat_caps;             ///< of all passes
    CombinedImage image;
    AnyModel model;  ///< guide of the last pass
    const SdTree& tree() const { return *model.get_if<SdTree>(); }
};

LocalRender render_locally(const Scene& scene, const Job& job);

}  // namespace treefarm::test
