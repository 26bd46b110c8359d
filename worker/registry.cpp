// SPDX-License-Identifier: Apache-2.0
#include "worker/registry.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/timer.h"
#include "common/config/aov_list.h"
#include "common/config/estimators.h"
#include "worker/integrators/first_hit/first_hit.h"
#include "worker/integrators/integrators.h"

namespace treefarm {

namespace {

constexpr Integrator kIntegrators[] = {
    {"path", prepare_path},
    {"reference", prepare_reference},
    {"direct", prepare_direct},
    {"normals", prepare_normals},
    {"ao", prepare_ao},
    {"light", prepare_light},
    {"bidirectional", prepare_bidirectional},
};

/// Throws RunError for a unit that does not fit pass and film: units come in messages, which may contain anything.
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

/// Renderer with AOVs, from an integrator that knows none.
///
/// The direct-light AOV is the result of the same integrator for the same unit with paths of at most two edges. Random
/// numbers are keyed, and roulette and splitting begin later, so that each of its samples equals the beginning of the
/// full one, by the same guide. Its records are dropped.
RenderUnit with_aovs(const Integrator& integrator, const std::shared_ptr<const TraceScene>& scene, const Camera& camera,
                     const Resolved& job, const AovLayout& layout) {
    constexpr int kDirectDepth = 2;
    Resolved direct_job = job;
    direct_job.integrator.max_depth =
        job.integrator.max_depth < 0 ? kDirectDepth : std::min(job.integrator.max_depth, kDirectDepth);
    return [first_hit = FirstHitRenderer(scene, camera, job.sampler.seed, layout), render = prepare(job, scene),
            direct = layout.direct() ? integrator.prepare(scene, direct_job) : RenderUnit()](
               const PassPlan& pass, const AnySampler& guide, const WorkUnit& unit, UnitOutput& output) {
        render(pass, guide, unit, output);
        if (unit.kind != UnitKind::tile) return;
        const double start = thread_cpu_seconds();
        first_hit.render(pass, unit, output.aovs);
        if (direct) {
            UnitOutput part;
            part.begin(guide);
            direct(pass, guide, unit, part);
            output.aovs.direct = std::move(part.pixels);
        }
        output.stats.trace_seconds += thread_cpu_seconds() - start;
    };
}

}  // namespace

std::span<const Integrator> integrators() {
    return kIntegrators;
}

const Integrator& integrator_of(const std::string& type) {
    for (const Integrator& integrator : kIntegrators)
        if (type == integrator.type) return integrator;
    throw RunError("the program has no integrator \"" + type + "\"");
}

RenderUnit prepare(const Resolved& job, const std::shared_ptr<const TraceScene>& scene) {
    const Integrator& integrator = integrator_of(job.integrator.type);
    if (estimator_of(job.integrator.type).from != PathsFrom::both ||
        job.bidirectional.light_subpaths != Rule::while_it_pays)
        return integrator.prepare(scene, job);
    return [both = integrator.prepare(scene, job), camera = prepare_path(scene, job)](
               const PassPlan& pass, const AnySampler& guide, const WorkUnit& unit, UnitOutput& output) {
        (pass.light_subpaths ? both : camera)(pass, guide, unit, output);
    };
}

RenderUnit make_renderer(Scene scene, const Resolved& job) {
    const Integrator& integrator = integrator_of(job.integrator.type);
    const Camera camera = scene.camera;
    const auto trace_scene = std::make_shared<const TraceScene>(std::move(scene), job);
    const AovLayout layout(aov_requests(job));
    RenderUnit render =
        layout.empty() ? prepare(job, trace_scene) : with_aovs(integrator, trace_scene, camera, job, layout);
    return [trace_scene, render = std::move(render)](const PassPlan& pass, const AnySampler& guide,
                                                     const WorkUnit& unit, UnitOutput& output) {
        check_unit(unit, pass, *trace_scene);
        render(pass, guide, unit, output);
    };
}

}  // namespace treefarm
