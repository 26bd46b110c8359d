// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/guiding/any_guide.h"
#include "common/plan/schedule/schedule.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// A path as render_unit() traces it, vertex by vertex, as text. `sample` counts within the pass.
std::string describe_sample(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide,
                            int x, int y, std::uint32_t sample);

}  // namespace treefarm
