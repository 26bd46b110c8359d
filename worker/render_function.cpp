#include "worker/render_function.h"

#include <memory>

#include "common/scene/scene_codec.h"
#include "worker/integrator/tile_renderer.h"

namespace treefarm {

namespace {

void check_unit(const WorkUnit& unit, const PassPlan& pass, const Film& film) {
    if (unit.x0 >= unit.x1 || unit.y0 >= unit.y1 || unit.x1 > film.width || unit.y1 > film.height ||
        unit.chunk >= pass.chunks)
        throw RunError("a work unit that does not fit the film");
}

}  // namespace

RenderUnit make_path_renderer(std::span<const std::uint8_t> scene, const Job& job) {
    const auto trace_scene = std::make_shared<const TraceScene>(decode_scene(scene), job);
    return [trace_scene, job](const PassPlan& pass, const Guide& guide, const WorkUnit& unit,
                              std::vector<PixelEstimate>& pixels, RecordLog& log, TraceStats& stats) {
        check_unit(unit, pass, trace_scene->film());
        render_unit(*trace_scene, job, pass, guide, unit, pixels, log, stats);
    };
}

}  // namespace treefarm
