// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"
#include "common/base/timer.h"
#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {
namespace {

const TileKernel& kernel(const KernelChoice& choice) {
    for (const auto& kernels : {diffuse_kernels(), general_kernels(), viewed_kernels()})
        for (const TileKernel& kernel : kernels)
            if (kernel.choice == choice) return kernel;
    throw RunError("the program has no kernel \"" + choice.name() + "\"");
}

}  // namespace

std::vector<KernelChoice> compiled_kernels() {
    std::vector<KernelChoice> choices;
    for (const auto& kernels : {diffuse_kernels(), general_kernels(), viewed_kernels()})
        for (const TileKernel& kernel : kernels)
            choices.push_back(kernel.choice);
    return choices;
}

void render_unit(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const SdTreeSampler& guide,
                 const WorkUnit& unit, std::vector<PixelEstimate>& pixels, RecordLog& log, TraceStats& stats) {
    const double start = thread_cpu_seconds();
    pixels.clear();
    pixels.reserve(unit.pixel_count());
    log.begin(pass.record ? guide.distribution_count() : 0);
    const TileJob tile{scene, job, pass, guide, unit, pixels, log, stats};
    kernel(pass.kernel).render(tile);
    stats.trace_seconds += thread_cpu_seconds() - start;
}

}  // namespace treefarm
