// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/integrators.h"
#include "worker/integrators/reference/path_tracer.h"
#include "worker/integrators/sample_loop.h"

namespace treefarm {

RenderUnit prepare_reference(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    return [scene = std::move(scene), job](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                           UnitOutput& output) {
        with_surface(*scene, [&]<class Surface>() {
            PathTracer<Surface> tracer(*scene, PathRules(*scene, job.integrator, pass), output.stats);
            render_samples(*scene, job, pass, unit, output,
                           [&](const PathKey& key, const Ray& ray) { return tracer.radiance(key, ray); });
        });
    };
}

}  // namespace treefarm
