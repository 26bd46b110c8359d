// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/learning.h"
#include "worker/integrators/integrators.h"
#include "worker/integrators/path/tile_renderer.h"

namespace treefarm {

RenderUnit prepare_path(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    return [scene = std::move(scene), job](const PassPlan& pass, const AnySampler& guide, const WorkUnit& unit,
                                           UnitOutput& output) {
        // The scene was prepared for the kernels of the job's guide.
        if (guide.kind() != guide_kind(job) || !fits(pass, scene->plainly_diffuse(), facts_of(guide)))
            throw RunError("a pass whose kernel does not fit the scene and the tree");
        render_unit(*scene, job, pass, guide, unit, output.pixels, output.log, output.stats);
    };
}

}  // namespace treefarm
