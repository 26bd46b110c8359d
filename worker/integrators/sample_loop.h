// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/base/timer.h"
#include "common/film/pass_film.h"
#include "common/film/work_unit.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/unit_output.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Walks through the samples of a unit: pixel by pixel, row by row.
struct UnitCursor {
    const WorkUnit& unit;
    std::uint32_t first, last;  ///< samples of a pixel
    int x = unit.x0, y = unit.y0;
    std::uint32_t sample = first;

    UnitCursor(const PassPlan& pass, const WorkUnit& unit)
        : unit(unit),
          first(unit.chunk * pass.blocks_per_unit * kBlockSamples),
          last(std::min(first + pass.blocks_per_unit * kBlockSamples, pass.spp)) {}

    bool done() const { return y == unit.y1 || first >= last; }
    /// Goes on to the next sample; true if the last one was its pixel's last.
    bool advance() {
        if (++sample < last) return false;
        sample = first;
        if (++x == unit.x1) {
            x = unit.x0;
            ++y;
        }
        return true;
    }
};

/// The film's door: what is not a radiance counts as black, is counted, and can be reproduced from what is kept.
void refuse_invalid(Rgb& radiance, const WorkUnit& unit, int x, int y, std::uint32_t sample, TraceStats& stats);

/// Fills the pixels of a unit sample by sample, for integrators that need no batches: `radiance(key, ray)` is what
/// arrives at the camera along `ray`, by the random numbers of `key`.
template <class Radiance>
void render_samples(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const WorkUnit& unit,
                    UnitOutput& output, Radiance radiance) {
    const double start = thread_cpu_seconds();
    const bool is_signed = scene.film().is_signed();
    std::vector<PixelEstimate> blocks;
    output.pixels.reserve(unit.pixel_count());
    for (UnitCursor at(pass, unit); !at.done();) {
        if (at.sample % kBlockSamples == 0) blocks.emplace_back();
        const PathKey key{job.sampler.seed, scene.film().key_of(at.x, at.y), pass.first_sample + at.sample};
        Rgb sample = radiance(key, scene.camera().generate(at.x, at.y, key));
        refuse_invalid(sample, unit, at.x, at.y, at.sample, output.stats);
        ++output.stats.paths;
        if (!is_black(sample)) ++output.stats.nonzero_paths;
        blocks.back().add(key.sample, is_signed ? sample * scene.camera().weight(key) : sample);
        if (at.advance()) {
            output.pixels.push_back(reduce_blocks(blocks));
            blocks.clear();
        }
    }
    output.stats.trace_seconds += thread_cpu_seconds() - start;
}

}  // namespace treefarm
