// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/integrators.h"
#include "worker/integrators/sample_loop.h"

namespace treefarm {

RenderUnit prepare_normals(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    return [scene = std::move(scene), job](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                           UnitOutput& output) {
        render_samples(*scene, job, pass, unit, output, [&](const PathKey&, const Ray& ray) {
            Hit hit;
            ++output.stats.rays;
            if (!scene->geometry().intersect(ray, hit)) return Rgb(0.0f);
            return Rgb(0.5f + 0.5f * hit.ns.x, 0.5f + 0.5f * hit.ns.y, 0.5f + 0.5f * hit.ns.z);
        });
    };
}

}  // namespace treefarm
