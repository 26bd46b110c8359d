// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/integrators.h"
#include "worker/integrators/sample_loop.h"
#include "worker/integrators/subpath/surface_light.h"

namespace treefarm {

RenderUnit prepare_normals(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    return [scene = std::move(scene), job](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                           UnitOutput& output) {
        with_surface(*scene, [&]<class Surface>() {
            auto scratch = Surface::make_scratch(*scene);
            render_samples(*scene, job, pass, unit, output, [&](const PathKey&, const Ray& ray) {
                Hit hit;
                ++output.stats.rays;
                if (!scene->geometry().intersect(ray, hit)) return Rgb(0.0f);
                const Surface surface(*scene, hit, -ray.direction, scratch);
                const bool back = surface.front() != hit.ns;
                const Vec3 n = back ? -surface.bent_normal() : surface.bent_normal();
                return Rgb(0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z);
            });
        });
    };
}

}  // namespace treefarm
