// SPDX-License-Identifier: Apache-2.0
#include "worker/render_function.h"

#include <memory>

#include "common/plan/kernel.h"
#include "common/plan/resolve.h"
#include "common/scene/pack/scene_codec.h"
#include "worker/integrators/path/tile_renderer.h"

namespace treefarm {

namespace {

void check_unit(const WorkUnit& unit, const PassPlan& pass, const Guide& guide, const TraceScene& scene) {
    const Film& film = scene.film();
    if (unit.x0 >= unit.x1 || unit.y0 >= unit.y1 || unit.x1 > film.width || unit.y1 > film.height ||
        unit.chunk >= pass.chunks)
        throw RunError("a work unit that does not fit the film");
    if (!fits(pass, scene.plainly_diffuse(), {guide.trained(), guide.view_count() > 0}))
        throw RunError("a pass whose kernel does not fit the scene and the tree");
}

}  // namespace

RenderUnit make_path_renderer(std::span<const std::uint8_t> scene, const Job& job) {
    Scene decoded = decode_scene(scene);
    const Resolved resolved = resolve(job, decoded);
    const auto trace_scene = std::make_shared<const TraceScene>(std::move(decoded), job);
    return [trace_scene, resolved](const PassPlan& pass, const Guide& guide, const WorkUnit& unit,
                                   std::vector<PixelEstimate>& pixels, RecordLog& log, TraceStats& stats) {
        check_unit(unit, pass, guide, *trace_scene);
        render_unit(*trace_scene, resolved, pass, guide, unit, pixels, log, stats);
    };
}

}  // namespace treefarm
