#pragma once

#include <algorithm>
#include <span>

#include "common/film/pass_film.h"
#include "common/plan/kernel.h"
#include "worker/integrator/path_kernel.h"
#include "worker/integrator/tile_renderer.h"

namespace treefarm {

/// What a work unit is rendered by, with what it is filled into.
struct TileJob {
    const TraceScene& scene;
    const Job& job;
    const PassPlan& pass;
    const Guide& guide;
    const WorkUnit& unit;
    std::vector<PixelEstimate>& pixels;
    RecordLog& log;
    TraceStats& stats;
};

/// An instance of the path kernel.
struct TileKernel {
    KernelChoice choice;
    void (*render)(const TileJob&);
};

/// The kernels of a kind of surface. Each kind is compiled by itself: the compiler inlines less where there are more.
std::span<const TileKernel> diffuse_kernels();
std::span<const TileKernel> general_kernels();

/// The film's door: what is not a radiance counts as black, is counted, and can be reproduced from what is kept.
bool refuse_invalid(Rgb& radiance, const WorkUnit& unit, int x, int y, std::uint32_t sample, TraceStats& stats);

template <class Surface, bool kGuided, bool kRecord>
void render_with(const TileJob& tile) {
    static_assert(kBlockSamples % PathKernel<Surface, kGuided, kRecord>::kBatch == 0);
    const auto& [scene, job, pass, guide, unit, pixels, log, stats] = tile;
    PathKernel<Surface, kGuided, kRecord> kernel(scene, guide, PathSettings(scene, job, pass, guide), stats);
    const std::uint32_t first = unit.chunk * pass.blocks_per_unit * kBlockSamples;
    const std::uint32_t last = std::min(first + pass.blocks_per_unit * kBlockSamples, pass.spp);
    std::vector<PixelEstimate> blocks;
    for (int y = unit.y0; y < unit.y1; ++y) {
        for (int x = unit.x0; x < unit.x1; ++x) {
            blocks.clear();
            PathKey path{job.sampler.seed, static_cast<std::uint32_t>(y * std::int64_t(scene.film().width) + x), 0};
            for (std::uint32_t sample = first; sample < last;) {
                if (sample % kBlockSamples == 0) blocks.emplace_back();
                // Within a block: which paths walk together then depends on nothing but the pass.
                const std::uint32_t count = std::min(kernel.kBatch, last - sample);
                kernel.clear();
                for (std::uint32_t i = 0; i < count; ++i) {
                    path.sample = pass.first_sample + sample + i;
                    kernel.add(path, scene.camera().generate(x, y, path));
                }
                kernel.trace();
                for (std::uint32_t i = 0; i < count; ++i, ++sample) {
                    path.sample = pass.first_sample + sample;
                    Rgb radiance = kernel.radiance(i);
                    const bool refused = refuse_invalid(radiance, unit, x, y, sample, stats);
                    if (!is_black(radiance)) ++stats.nonzero_paths;
                    if constexpr (kRecord)
                        if (!refused) stats.records += kernel.recorder(i).commit(path, log);
                    blocks.back().add(path.sample, radiance);
                }
            }
            stats.paths += last - std::min(first, last);
            pixels.push_back(reduce_blocks(blocks));
        }
    }
}

template <class Surface>
inline constexpr TileKernel kKernelsOf[] = {
    {{!Surface::kGeneral, false, false}, render_with<Surface, false, false>},
    {{!Surface::kGeneral, false, true}, render_with<Surface, false, true>},
    {{!Surface::kGeneral, true, false}, render_with<Surface, true, false>},
    {{!Surface::kGeneral, true, true}, render_with<Surface, true, true>},
};

}  // namespace treefarm
