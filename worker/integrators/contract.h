// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/config/job.h"
#include "common/film/work_unit.h"
#include "common/guiding/any_guide.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/unit_output.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Renders a work unit: a pure function of its arguments' values and of the scene and job it was made for. Called by
/// many threads at once with different outputs, each begun by its caller.
using RenderUnit = std::function<void(const PassPlan&, const AnySampler&, const WorkUnit&, UnitOutput&)>;

/// Makes ready for tracing what the coordinator sent; called once, may take long.
using MakeRenderer = std::function<RenderUnit(std::span<const std::uint8_t> scene, const Job&)>;

/// An estimator: a name, and how it is made ready for a scene and a job. What an estimator can do stands in its folder;
/// nothing outside worker/integrators names one.
struct Integrator {
    const char* type;  ///< value of integrator.type
    RenderUnit (*prepare)(std::shared_ptr<const TraceScene>, const Resolved&);
};

}  // namespace treefarm
