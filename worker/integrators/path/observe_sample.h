// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/guiding/any_guide.h"
#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/path/path_events.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Radiance of a path as render_unit() traces it, to the bit, told vertex by vertex. `sample` counts within the pass.
/// It knows nothing of how bright the pixel is: that only decides what a pass counts, never where a path goes. Defined
/// where guides are known (worker/guides).
Rgb observe_sample(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide, int x,
                   int y, std::uint32_t sample, PathEvents& events);

}  // namespace treefarm
