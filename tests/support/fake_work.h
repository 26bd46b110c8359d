// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/base/random.h"
#include "common/film/pass_film.h"
#include "worker/integrators/contract.h"
#include "worker/pass_work.h"

namespace treefarm::test {

/// Radiance of a pixel in the image of the fake renderer's splats.
inline Rgb splatted_radiance(std::uint32_t pixel) {
    return {0.25f + 0.25f * static_cast<float>(pixel % 5), 1.0f, 0.125f * static_cast<float>(pixel % 3)};
}

/// Splats of a path: two vertices, each with half of the image's radiance for some pixel, three times out of five.
inline void fake_splats(SplatLog& splats, const PathKey& key, std::uint32_t pixels) {
    for (std::uint32_t vertex = 0; vertex < 2; ++vertex) {
        const Draw d = draw(key, vertex, Stream::light);
        if (to_unit(d[0]) >= 0.6f) continue;
        const auto pixel = static_cast<std::uint32_t>(std::uint64_t{d[1]} * pixels >> 32);
        const float value = 2 * to_unit(d[2]) * 0.5f / 0.6f;
        splats.add(pixel, key.sample, splatted_radiance(pixel) * value, draw(key, vertex, Stream::light_record));
    }
}

inline void fake_light_paths(std::uint64_t seed, const PassPlan& pass, const WorkUnit& unit, UnitOutput& output) {
    const std::uint32_t pixels = pass.layers.splats.pixels;
    for (std::uint64_t i = unit.first; i < unit.first + unit.count; ++i) {
        ++output.stats.paths;
        const auto sample = pass.units.first_light_path + static_cast<std::uint32_t>(i / pixels);
        fake_splats(output.splats, {seed, static_cast<std::uint32_t>(i % pixels), sample}, pixels);
    }
}

/// A chain of `steps` splats, each of which repeats the previous one with probability 0.9: independent ones would have
/// a nineteenth of its variance.
inline void fake_chain(SplatLog& splats, std::uint64_t seed, std::uint32_t chain, std::uint32_t steps,
                       std::uint32_t pixels) {
    std::uint32_t pixel = 0;
    for (std::uint32_t step = 0; step < steps; ++step) {
        const PathKey key{seed, step, chain};
        const Draw d = draw(key, 0, Stream::light);
        if (step == 0 || to_unit(d[0]) < 0.1f) pixel = static_cast<std::uint32_t>(std::uint64_t{d[1]} * pixels >> 32);
        splats.add(pixel, chain, splatted_radiance(pixel), draw(key, 1, Stream::light));
    }
    splats.end_chain();
}

/// Number of steps of a chain: in total the number of the pass's samples.
inline std::uint32_t chain_steps(const PassPlan& pass) {
    return pass.layers.splats.pixels * pass.spp / pass.units.chains;
}

inline void fake_chains(std::uint64_t seed, const PassPlan& pass, const WorkUnit& unit, UnitOutput& output) {
    for (std::uint64_t i = unit.first; i < unit.first + unit.count; ++i) {
        ++output.stats.paths;  // work is counted in chains
        fake_chain(output.splats, seed + pass.index, static_cast<std::uint32_t>(i), chain_steps(pass),
                   pass.layers.splats.pixels);
    }
}

/// Renderer without a scene, for a film of `width` columns: radiance, records and splats come straight from the keyed
/// generator. Tiles' samples splat if the pass has splats but no light paths.
inline RenderUnit fake_renderer(std::uint64_t seed, std::uint32_t width) {
    return [seed, width](const PassPlan& pass, const AnySampler& guide, const WorkUnit& unit, UnitOutput& output) {
        if (unit.kind == UnitKind::light_paths) return fake_light_paths(seed, pass, unit, output);
        if (unit.kind == UnitKind::chains) return fake_chains(seed, pass, unit, output);
        auto& [pixels, logs, stats, aovs, splats] = output;
        RecordLog& log = logs.of<SdTreeGuide>();
        const bool splatting = pass.layers.splats.pixels > 0 && pass.units.light_paths == 0;
        const std::uint32_t run = kBlockSamples * pass.blocks_per_unit;
        const std::uint32_t first = run * unit.chunk, last = std::min(first + run, pass.spp);
        for (std::uint32_t y = unit.y0; y < unit.y1; ++y)
            for (std::uint32_t x = unit.x0; x < unit.x1; ++x) {
                std::vector<PixelEstimate> blocks;
                for (std::uint32_t sample = first; sample < last; ++sample) {
                    if (sample % kBlockSamples == 0) blocks.emplace_back();
                    const PathKey key{seed, y * width + x, pass.first_sample + sample};
                    const Draw d = draw(key, 0, Stream::scatter);
                    const float value = to_unit(d[0]);
                    blocks.back().add(key.sample, Rgb(value, value * value, 1.0f));
                    if (splatting) fake_splats(splats, key, pass.layers.splats.pixels);
                    ++stats.paths;
                    stats.rays += 2;
                    if (!pass.record) continue;
                    const std::uint32_t region = guide.regions().region({to_unit(d[1]), to_unit(d[2]), 0.5f});
                    ++log.counts[region];
                    ++stats.records;
                    if (value > 0.5f) log.records.push_back({region, d[3] & d[1], d[2], value});
                }
                if (pass.layers.estimates) pixels.push_back(reduce_blocks(blocks));
            }
    };
}

/// Result of a worker with fake_renderer() for these units.
inline Result fake_result(const PassPlan& plan, std::span<const std::uint8_t> tree, std::span<const WorkUnit> units,
                          std::uint32_t width) {
    PassWork work(plan, decode_tree(tree), DirectionalFilter::box);
    const RenderUnit render = fake_renderer(0, width);
    for (const WorkUnit& unit : units) {
        UnitOutput output;
        output.begin(work.guide(), plan.layers.splats);
        render(plan, work.guide(), unit, output);
        work.deliver(unit, output);
    }
    return std::move(*work.close());
}

}  // namespace treefarm::test
