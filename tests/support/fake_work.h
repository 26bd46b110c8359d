// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/base/random.h"
#include "common/film/pass_film.h"
#include "worker/integrators/contract.h"
#include "worker/pass_work.h"

namespace treefarm::test {

/// A renderer without a scene, on a film of so many columns: radiance and records come straight from the keyed
/// generator.
inline RenderUnit fake_renderer(std::uint64_t seed, std::uint32_t width) {
    return [seed, width](const PassPlan& pass, const Guide& guide, const WorkUnit& unit, UnitOutput& output) {
        auto& [pixels, log, stats, aovs] = output;
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
                    ++stats.paths;
                    stats.rays += 2;
                    if (!pass.record) continue;
                    const std::uint32_t region = guide.region({to_unit(d[1]), to_unit(d[2]), 0.5f});
                    ++log.counts[region];
                    ++stats.records;
                    if (value > 0.5f) log.records.push_back({region, d[3] & d[1], d[2], value});
                }
                pixels.push_back(reduce_blocks(blocks));
            }
    };
}

/// A worker's result of these units by fake_renderer().
inline Result fake_result(const PassPlan& plan, std::span<const std::uint8_t> tree, std::span<const WorkUnit> units,
                          std::uint32_t width) {
    PassWork work(plan, decode_tree(tree), DirectionalFilter::box);
    const RenderUnit render = fake_renderer(0, width);
    for (const WorkUnit& unit : units) {
        UnitOutput output;
        output.begin(work.guide().distribution_count());
        render(plan, work.guide(), unit, output);
        work.deliver(unit, output);
    }
    return std::move(*work.close());
}

}  // namespace treefarm::test
