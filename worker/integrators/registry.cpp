// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/registry.h"

#include "common/base/error.h"
#include "common/plan/resolve.h"
#include "common/scene/pack/scene_codec.h"
#include "worker/integrators/path/path_integrator.h"

namespace treefarm {

namespace {

constexpr Integrator kIntegrators[] = {
    {"path", prepare_path},
};

const Integrator& integrator_of(const Job& job) {
    for (const Integrator& integrator : kIntegrators)
        if (job.integrator.type == integrator.type) return integrator;
    throw RunError("the program has no integrator \"" + job.integrator.type + "\"");
}

/// Units come in messages, and a message may say anything.
void check_unit(const WorkUnit& unit, const PassPlan& pass, const TraceScene& scene) {
    const Film& film = scene.film();
    const auto within = [&](std::uint64_t count) { return unit.first <= count && unit.count <= count - unit.first; };
    bool fits = false;
    switch (unit.kind) {
        case UnitKind::tile:
            fits = pass.units.tiles && unit.x0 < unit.x1 && unit.y0 < unit.y1 && unit.x1 <= film.width &&
                   unit.y1 <= film.height && unit.chunk < pass.chunks;
            break;
        case UnitKind::light_paths:
            fits = within(std::uint64_t{pass.units.light_paths} * film.pixel_count());
            break;
        case UnitKind::chains:
            fits = within(pass.units.chains);
            break;
    }
    if (!fits) throw RunError("a work unit that does not fit the film");
}

}  // namespace

std::span<const Integrator> integrators() {
    return kIntegrators;
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
