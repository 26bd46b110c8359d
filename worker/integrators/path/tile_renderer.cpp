// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"
#include "common/base/timer.h"
#include "worker/integrators/path/observe_sample.h"
#include "worker/integrators/path/origin_finder.h"
#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {
namespace {

const TileKernel& kernel(const KernelChoice& choice, GuideKind guide) {
    for (const TileKernel& kernel : unguided_kernels())
        if (kernel.choice == choice) return kernel;
    for (const KernelList list : kernels_of(guide))
        for (const TileKernel& kernel : list())
            if (kernel.choice == choice) return kernel;
    throw RunError("the program has no kernel \"" + choice.name() + "\"");
}

/// Traces the worst sample once more to find its light's origin, and reports it. Dropped if the value differs, since
/// the origin would then be another sample's.
void report(const TailSample& worst, const Rgb& value, const TileJob& tile) {
    OriginFinder finder;
    Rgb again = observe_sample(tile.scene, tile.job, tile.pass, tile.guide, worst.x, worst.y, worst.sample, finder);
    const Film& film = tile.scene.film();
    if (film.is_signed())
        again = again * tile.scene.camera().weight({tile.job.sampler.seed, film.key_of(worst.x, worst.y),
                                                    tile.pass.first_sample + worst.sample});
    if (again != value) return;
    TailSample sample = worst;
    sample.origin = finder.origin();
    tile.stats.tails.add(sample);
}

}  // namespace

std::vector<KernelChoice> compiled_kernels(GuideKind guide) {
    std::vector<KernelChoice> choices;
    for (const TileKernel& kernel : unguided_kernels())
        choices.push_back(kernel.choice);
    for (const KernelList list : kernels_of(guide))
        for (const TileKernel& kernel : list())
            choices.push_back(kernel.choice);
    return choices;
}

void render_unit(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide,
                 const WorkUnit& unit, std::vector<PixelEstimate>& pixels, AnyLog& log, UnitStats& stats) {
    const double start = thread_cpu_seconds();
    pixels.clear();
    pixels.reserve(unit.pixel_count());
    const RegionSampler& regions = guide.regions();
    log.begin(guide.kind(), pass.record ? regions.distribution_count() : 0,
              pass.record && counts_next_event(job, pass, regions) ? regions.region_count() : 0);
    WorstSample worst;
    const TileJob tile{scene, job, pass, guide, unit, pixels, log, stats, worst};
    kernel(pass.kernel, guide.kind()).render(tile);
    if (worst.found()) report(worst.worst(), worst.value(), tile);
    stats.trace_seconds += thread_cpu_seconds() - start;
}

}  // namespace treefarm
