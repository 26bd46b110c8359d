// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/film/work_unit.h"
#include "common/guiding/any_guide.h"
#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "worker/integrators/unit_output.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Renderer of a work unit: a pure function of its arguments' values and of its scene and job. Called by many threads
/// at once with different outputs, each cleared by its caller.
using RenderUnit = std::function<void(const PassPlan&, const AnySampler&, const WorkUnit&, UnitOutput&)>;

/// Preparation of a scene and of a job that is resolved for it; once per job, may take seconds.
using MakeRenderer = std::function<RenderUnit(Scene, const Resolved&)>;

/// An estimator: its name, and the function that prepares it for a scene and a job. Its capabilities are stated in its
/// own folder; no code outside worker/integrators names an estimator.
struct Integrator {
    const char* type;  ///< value of integrator.type
    RenderUnit (*prepare)(std::shared_ptr<const TraceScene>, const Resolved&);
};

}  // namespace treefarm
