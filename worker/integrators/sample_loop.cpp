// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/sample_loop.h"

#include "worker/integrators/subpath/radiance.h"

namespace treefarm {

void refuse_invalid(Rgb& radiance, const WorkUnit& unit, int x, int y, std::uint32_t sample, TraceStats& stats) {
    if (is_radiance(radiance)) return;
    ++stats.invalid_samples;
    if (stats.first_invalid.size() < TraceStats::kMaxReported)
        stats.first_invalid.push_back({unit.pass,
                                       static_cast<std::uint16_t>(x),
                                       static_cast<std::uint16_t>(y),
                                       sample,
                                       {radiance.x, radiance.y, radiance.z}});
    radiance = Rgb(0.0f);
}

}  // namespace treefarm
