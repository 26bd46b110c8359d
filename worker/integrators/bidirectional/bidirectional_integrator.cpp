// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/bidirectional/bidirectional_tracer.h"
#include "worker/integrators/integrators.h"
#include "worker/integrators/sample_loop.h"

// A path of k edges from lamp to lens has k + 1 vertices. A technique (s, t) draws s of them from the lamp and t from
// the camera, s + t = k + 1, and connects the two ends:
//
//     (0, t)  the camera subpath hits the lamp by chance         (s, 1)  a light vertex is connected to the lens
//     (1, t)  next event: a point is sampled on a lamp           (s, t)  two vertices are connected
//
// Each technique finds all light of that many edges, except where it has no density: a point light is never hit, a
// mirror is never connected. For each sample one subpath is traced from either end, and all pairs of their vertices are
// connected. A technique is weighted by its density for the path against those of all the others (multiple importance
// sampling), so that each kind of light is left to the techniques that find it often. The weights of one path's
// techniques sum to one: the mean of many samples is the image. Only (s, 1) contributes to pixels other than the
// sample's own: it splats.

namespace treefarm {

RenderUnit prepare_bidirectional(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    const Sensor sensor(scene->camera().camera(), scene->film());
    return [sensor, scene = std::move(scene), job](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                                   UnitOutput& output) {
        with_surface(*scene, [&]<class Surface>() {
            const EmissionChoice choice = scene->emitters().emission_choice(pass.emission);
            EmissionRecord record(choice, job.learns_emission, pass, output.stats.sums<EmissionSums>());
            BidirectionalTracer<Surface> tracer(*scene, sensor, BidirectionalRules(*scene, job, pass), choice, record,
                                                pass, output);
            render_samples(*scene, job, pass, unit, output,
                           [&](const PathKey& key, const Ray& ray) { return tracer.radiance(key, ray); });
            tracer.finish();
        });
    };
}

}  // namespace treefarm
