// SPDX-License-Identifier: Apache-2.0
#include "common/base/timer.h"
#include "worker/integrators/integrators.h"
#include "worker/integrators/light/light_tracer.h"

namespace treefarm {

RenderUnit prepare_light(std::shared_ptr<const TraceScene> scene, const Resolved& job) {
    const Sensor sensor(scene->camera().camera(), scene->film());
    return [sensor, scene = std::move(scene), job](const PassPlan& pass, const AnySampler&, const WorkUnit& unit,
                                                   UnitOutput& output) {
        const double start = thread_cpu_seconds();
        const EmissionChoice choice = scene->emitters().emission_choice(pass.emission);
        EmissionRecord record(choice, job.learns_emission, pass, output.stats.sums<EmissionSums>());
        with_surface(*scene, [&]<class Surface>() {
            LightTracer<Surface> tracer(*scene, sensor, LightPathRules(job.integrator), choice, record, output);
            const std::uint64_t pixels = pass.layers.splats.pixels;
            for (std::uint64_t path = unit.first; path < unit.first + unit.count; ++path)
                tracer.trace({job.sampler.seed, static_cast<std::uint32_t>(path % pixels),
                              pass.units.first_light_path + static_cast<std::uint32_t>(path / pixels)});
            tracer.finish();
        });
        output.stats.trace_seconds += thread_cpu_seconds() - start;
    };
}

}  // namespace treefarm
