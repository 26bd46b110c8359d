// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/config/job.h"
#include "common/film/pixel_estimate.h"
#include "common/film/trace_stats.h"
#include "common/film/work_unit.h"
#include "common/guiding/guide.h"
#include "common/plan/schedule.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Traces a work unit: a pure function of its arguments' values and of the scene it was made for. Called by many
/// threads at once with different outputs. The record log is begun by the caller.
using RenderUnit = std::function<void(const PassPlan&, const Guide&, const WorkUnit&,
                                      std::vector<PixelEstimate>& pixels, RecordLog&, TraceStats&)>;

/// Makes ready for tracing what the coordinator sent; called once, may take long.
using MakeRenderer = std::function<RenderUnit(std::span<const std::uint8_t> scene, const Job&)>;

/// The real one: decodes the scene, builds the hierarchy, renders with the job's integrator.
RenderUnit make_path_renderer(std::span<const std::uint8_t> scene, const Job& job);

}  // namespace treefarm
