// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/guiding/any_guide.h"
#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/path/path_events.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Radiance of a path as render_unit() traces it, to the bit, with each vertex reported to `events`. `sample` counts
/// within the pass. The pixel's brightness is not used: it affects the counts of a pass, not the paths. Defined with
/// the guides (worker/guides).
Rgb observe_sample(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide, int x,
                   int y, std::uint32_t sample, PathEvents& events);

}  // namespace treefarm
