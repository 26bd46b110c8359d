// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/film/pixel_estimate.h"
#include "common/film/work_unit.h"
#include "common/guiding/any_guide.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/record_log.h"
#include "worker/integrators/unit_stats.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Renders a work unit: a pure function of its arguments' values. `pixels` receives one reduced estimate per pixel, row
/// by row; `log` is cleared and filled if the pass records; `stats` is added to. Thread-safe for different outputs.
void render_unit(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide,
                 const WorkUnit& unit, std::vector<PixelEstimate>& pixels, AnyLog& log, UnitStats& stats);

/// Kernels among which render_unit() chooses for this guide; the plan names them.
std::vector<KernelChoice> compiled_kernels(GuideKind guide);

}  // namespace treefarm
