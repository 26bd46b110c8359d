// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/ao/ao_integrator.h"

#include "common/math/frame.h"
#include "worker/integrators/sample_loop.h"

namespace treefarm {

namespace {

/// How far away something darkens, in scene units.
float reach(const TraceScene& scene, const Resolved& job) {
    if (job.integrator.ao_distance > 0.0f) return job.integrator.ao_distance;
    const Box3& box = scene.bounds();
    if (box.isEmpty()) return 1.0f;
    const Imath::V3d diagonal = Imath::V3d(box.max) - Imath::V3d(box.min);
    return static_cast<float>(0.25 * std::sqrt(diagonal.dot(diagonal)));
}

}  // namespace

RenderUnit prepare_ao(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    const float length = reach(*scene, job);
    return [scene = std::move(scene), job, length](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                                   UnitOutput& output) {
        render_samples(*scene, job, pass, unit, output, [&](const PathKey& key, const Ray& ray) {
            Hit hit;
            ++output.stats.rays;
            if (!scene->geometry().intersect(ray, hit)) return Rgb(1.0f);
            const Draw random = draw(key, 1, Stream::scatter);
            const Frame frame(dot(hit.ns, ray.direction) > 0.0f ? -hit.ns : hit.ns);
            const Vec3 direction =
                frame.to_world(square_to_cosine_hemisphere({to_unit(random[2]), to_unit(random[3])}));
            ++output.stats.shadow_rays;
            return Rgb(scene->geometry().occluded({offset_origin(hit, direction), direction, length}) ? 0.0f : 1.0f);
        });
    };
}

}  // namespace treefarm
