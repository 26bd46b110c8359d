// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/registry.h"

#include "common/base/error.h"
#include "common/plan/resolve.h"
#include "common/scene/pack/scene_codec.h"
#include "worker/integrators/ao/ao_integrator.h"
#include "worker/integrators/direct/direct_integrator.h"
#include "worker/integrators/normals/normals_integrator.h"
#include "worker/integrators/path/path_integrator.h"
#include "worker/integrators/reference/reference_integrator.h"

namespace treefarm {

namespace {

constexpr Integrator kIntegrators[] = {
    {"path", prepare_path}, {"reference", prepare_reference}, {"direct", prepare_direct}, {"normals", prepare_normals},
    {"ao", prepare_ao},
};

/// Units come in messages, and a message may say anything.
void check_unit(const WorkUnit& unit, const PassPlan& pass, const TraceScene& scene) {
    const Film& film = scene.film();
    if (unit.x0 >= unit.x1 || unit.y0 >= unit.y1 || unit.x1 > film.width || unit.y1 > film.height ||
        unit.chunk >= pass.chunks)
        throw RunError("a work unit that does not fit the film");
}

}  // namespace

std::span<const Integrator> integrators() {
    return kIntegrators;
}

const Integrator& integrator_of(const Job& job) {
    for (const Integrator& integrator : kIntegrators)
        if (job.integrator.type == integrator.type) return integrator;
    throw RunError("the program has no integrator \"" + job.integrator.type + "\"");
}

RenderUnit make_renderer(std::span<const std::uint8_t> scene, const Job& job) {
    Scene decoded = decode_scene(scene);
    const Resolved resolved = resolve(job, decoded);
    const Integrator& integrator = integrator_of(resolved);
    const auto trace_scene = std::make_shared<const TraceScene>(std::move(decoded), job);
    return [trace_scene, render = integrator.prepare(trace_scene, resolved)](const PassPlan& pass, const Guide& guide,
                                                                             const WorkUnit& unit, UnitOutput& output) {
        check_unit(unit, pass, *trace_scene);
        render(pass, guide, unit, output);
    };
}

}  // namespace treefarm
