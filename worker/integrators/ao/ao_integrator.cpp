// SPDX-License-Identifier: Apache-2.0
#include "common/math/frame.h"
#include "worker/integrators/integrators.h"
#include "worker/integrators/sample_loop.h"

namespace treefarm {

RenderUnit prepare_ao(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    const float length = job.integrator.ao_distance;  // scene units
    return [scene = std::move(scene), job, length](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                                   UnitOutput& output) {
        render_samples(*scene, job, pass, unit, output, [&](const Numbers auto& numbers, const Ray& ray) {
            Hit hit;
            ++output.stats.rays;
            if (!scene->geometry().intersect(ray, hit)) return Rgb(1.0f);
            const Draw random = draw(numbers, 1, Stream::scatter);
            const Frame frame(dot(hit.ns, ray.direction) > 0.0f ? -hit.ns : hit.ns);
            const Vec3 direction =
                frame.to_world(square_to_cosine_hemisphere({to_unit(random[2]), to_unit(random[3])}));
            ++output.stats.shadow_rays;
            return Rgb(scene->geometry().occluded({offset_origin(hit, direction), direction, length}) ? 0.0f : 1.0f);
        });
    };
}

}  // namespace treefarm
