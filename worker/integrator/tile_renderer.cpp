#include "worker/integrator/tile_renderer.h"

#include <algorithm>

#include "common/base/timer.h"
#include "common/film/pass_film.h"
#include "worker/integrator/dispatch.h"
#include "worker/integrator/path_kernel.h"

namespace treefarm {
namespace {

bool is_valid(const Rgb& c) {
    return is_finite(c) && c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f;
}

/// The film's door: what is not a radiance counts as black, is counted, and can be reproduced from what is kept.
bool refuse_invalid(Rgb& radiance, const WorkUnit& unit, int x, int y, std::uint32_t sample, TraceStats& stats) {
    if (is_valid(radiance)) return false;
    ++stats.invalid_samples;
    if (stats.first_invalid.size() < TraceStats::kMaxReported)
        stats.first_invalid.push_back({unit.pass,
                                       static_cast<std::uint16_t>(x),
                                       static_cast<std::uint16_t>(y),
                                       sample,
                                       {radiance.x, radiance.y, radiance.z}});
    radiance = Rgb(0.0f);
    return true;
}

template <class Surface, bool kGuided, bool kRecord>
void render(const TraceScene& scene, const Job& job, const PassPlan& pass, const Guide& guide, const WorkUnit& unit,
            std::vector<PixelEstimate>& pixels, RecordLog& log, TraceStats& stats) {
    PathKernel<Surface, kGuided, kRecord> kernel(scene, guide, PathSettings(scene, job, pass, guide), stats);
    const std::uint32_t first = unit.chunk * pass.blocks_per_unit * kBlockSamples;
    const std::uint32_t last = std::min(first + pass.blocks_per_unit * kBlockSamples, pass.spp);
    std::vector<PixelEstimate> blocks;
    for (int y = unit.y0; y < unit.y1; ++y) {
        for (int x = unit.x0; x < unit.x1; ++x) {
            blocks.clear();
            PathKey path{job.sampler.seed, static_cast<std::uint32_t>(y * std::int64_t(scene.film().width) + x), 0};
            for (std::uint32_t sample = first; sample < last; ++sample) {
                if (sample % kBlockSamples == 0) blocks.emplace_back();
                path.sample = pass.first_sample + sample;
                Rgb radiance = kernel.trace(path, scene.camera().generate(x, y, draw(path, 0, Stream::camera)));
                const bool refused = refuse_invalid(radiance, unit, x, y, sample, stats);
                if (!is_black(radiance)) ++stats.nonzero_paths;
                if constexpr (kRecord)
                    if (!refused) stats.records += kernel.recorder().commit(path, log);
                blocks.back().add(path.sample, radiance);
            }
            stats.paths += last - std::min(first, last);
            pixels.push_back(reduce_blocks(blocks));
        }
    }
}

}  // namespace

void render_unit(const TraceScene& scene, const Job& job, const PassPlan& pass, const Guide& guide,
                 const WorkUnit& unit, std::vector<PixelEstimate>& pixels, RecordLog& log, TraceStats& stats) {
    const double start = thread_cpu_seconds();
    pixels.clear();
    pixels.reserve(unit.pixel_count());
    log.begin(pass.record ? guide.region_count() : 0);
    const bool guided = job.guiding.type != GuidingType::none && guide.trained();
    dispatch(scene.plainly_diffuse(), guided, pass.record, [&](auto surface, auto guides, auto records) {
        render<typename decltype(surface)::type, guides(), records()>(scene, job, pass, guide, unit, pixels, log,
                                                                      stats);
    });
    stats.trace_seconds += thread_cpu_seconds() - start;
}

}  // namespace treefarm
