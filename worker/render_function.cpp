#include "worker/render_function.h"

#include <memory>

#include "common/scene/scene_codec.h"
#include "worker/integrator/tile_renderer.h"

namespace treefarm {

RenderUnit make_path_renderer(std::span<const std::uint8_t> scene, const Job& job) {
    const auto trace_scene = std::make_shared<const TraceScene>(decode_scene(scene), job);
    return [trace_scene, job](const PassPlan& pass, const Guide& guide, const WorkUnit& unit,
                              std::vector<PixelEstimate>& pixels, RecordLog& log, TraceStats& stats) {
        render_unit(*trace_scene, job, pass, guide, unit, pixels, log, stats);
    };
}

}  // namespace treefarm
