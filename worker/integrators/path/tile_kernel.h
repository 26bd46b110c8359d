// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <type_traits>

#include "common/decide/splitting/splitting_gain.h"
#include "common/guiding/any_guide.h"
#include "common/plan/schedule/kernel.h"
#include "worker/integrators/path/path_kernel.h"
#include "worker/integrators/path/path_roulette.h"
#include "worker/integrators/path/tile_renderer.h"
#include "worker/integrators/path/worst_sample.h"
#include "worker/integrators/sample_loop.h"

namespace treefarm {

/// A work unit with all inputs of its rendering, and its outputs.
struct TileJob {
    const TraceScene& scene;
    const Resolved& job;
    const PassPlan& pass;
    const AnySampler& guide;
    const WorkUnit& unit;
    std::vector<PixelEstimate>& pixels;
    AnyLog& log;
    UnitStats& stats;
    WorstSample& worst;
};

/// One instance of the path kernel.
struct TileKernel {
    KernelChoice choice;
    void (*render)(const TileJob&);
};

/// Kernels of one translation unit. They are few, since the compiler inlines less in a larger unit.
using KernelList = std::span<const TileKernel> (*)();

/// Kernels of unguided paths that record nothing.
std::span<const TileKernel> unguided_kernels();
/// Kernels of a guide (worker/guides/kernels.cpp).
std::span<const KernelList> kernels_of(GuideKind kind);

/// Log of the walk's guide; none of unguided walks.
template <GuideWalk G>
LogOf<G>* log_of(AnyLog& logs) {
    if constexpr (std::is_same_v<typename G::Sampler, RegionSampler>)
        return nullptr;
    else
        return &logs.of<GuideOf<typename G::Sampler>>();
}

template <GuideWalk G, class Surface, bool kGuided, bool kRecord>
void render_with(const TileJob& tile) {
    const auto& [scene, job, pass, any_guide, unit, pixels, log, stats, worst] = tile;
    const auto& guide = any_guide.template get<typename G::Sampler>();
    const PathSettings settings(scene, job, pass, guide);
    PathKernel<G, Surface, kGuided, kRecord> kernel(scene, guide, settings, stats, log_of<G>(log));
    const bool is_signed = scene.film().is_signed();
    const auto key = [&tile](const UnitCursor& at) {
        return PathKey{tile.job.sampler.seed, tile.scene.film().key_of(at.x, at.y), tile.pass.first_sample + at.sample};
    };
    // Contributions are counted as the pixel receives them.
    const auto inverse_level = [&](const UnitCursor& at) {
        if (!settings.count_next_event && !settings.estimates_unguided) return 0.0f;
        const float level = guide.inverse_level(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y));
        return is_signed ? level * std::abs(tile.scene.camera().weight(key(at))) : level;
    };
    std::vector<PixelEstimate> blocks;
    PairedSamples pairs;
    UnguidedBlock unguided;
    std::size_t group = 0;  // pixel group that `tells` counts
    UnitCursor start(pass, unit), end(pass, unit);
    while (!start.done()) {
        kernel.clear();
        while (!kernel.full() && !start.done()) {
            kernel.add(key(start), scene.camera().generate(start.x, start.y, key(start)), inverse_level(start));
            start.advance();
        }
        kernel.trace();
        kernel.clock().start();
        for (std::uint32_t i = 0; i < kernel.count(); ++i) {
            if (end.sample % kBlockSamples == 0) {
                blocks.emplace_back();
                pairs.finish(stats.sums<SplittingSums>());
                if (settings.estimates_unguided) unguided.finish(group, stats.sums<UnguidedSums>());
                group = pixel_group(static_cast<std::uint32_t>(end.x), static_cast<std::uint32_t>(end.y));
            }
            Rgb radiance = kernel.radiance(i);
            refuse_invalid(radiance, unit, end.x, end.y, end.sample, stats);
            if (!is_black(radiance)) ++stats.nonzero_paths;
            const Rgb value = is_signed ? radiance * scene.camera().weight(key(end)) : radiance;
            blocks.back().add(key(end).sample, value);
            worst.see(value, end.sample);
            if (kGuided && kRecord && settings.compare_splitting) {
                const int record = kernel.first_exponent(i) + kMeanRecordBits;
                const double scale = std::ldexp(1.0, -radiance_exponent(record, settings.target));
                pairs.add(scale * luminance(radiance), scale * kernel.unsplit(i));
            }
            if constexpr (kGuided && kRecord)
                if (settings.estimates_unguided && is_radiance(kernel.radiance(i)))
                    unguided.add(static_cast<double>(luminance(radiance) * kernel.inverse_level(i)),
                                 static_cast<double>(kernel.unguided(i).moment),
                                 static_cast<double>(kernel.unguided(i).cost));
            const int x = end.x, y = end.y;
            if (end.advance()) {
                pixels.push_back(reduce_blocks(blocks));
                worst.finish(pass.index, x, y, pixels.back(), pass.spp);
                blocks.clear();
            }
        }
        kernel.clock().lap(TracePhase::record);
        stats.paths += kernel.count();
    }
    pairs.finish(stats.sums<SplittingSums>());
    if (settings.estimates_unguided) unguided.finish(group, stats.sums<UnguidedSums>());
}

/// Kernels of a guide for one kind of surface.
template <GuideWalk G, class Surface>
inline constexpr TileKernel kKernelsOf[] = {
    {{!Surface::kGeneral, false, true, G::kLocal}, render_with<G, Surface, false, true>},
    {{!Surface::kGeneral, true, false, G::kLocal}, render_with<G, Surface, true, false>},
    {{!Surface::kGeneral, true, true, G::kLocal}, render_with<G, Surface, true, true>},
};

}  // namespace treefarm
