// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// All estimators of the program.
std::span<const Integrator> integrators();

/// Estimator of that name. Throws RunError if the program has none.
const Integrator& integrator_of(const std::string& type);

/// Renderer of a job's passes, without AOVs: its integrator, or path tracing for passes without light subpaths, where
/// these may turn out not to pay.
RenderUnit prepare(const Resolved& job, const std::shared_ptr<const TraceScene>& scene);

/// Renderer of a job: builds the scene's hierarchy, prepares the integrator. Throws RunError for an unknown integrator.
RenderUnit make_renderer(Scene scene, const Resolved& job);

}  // namespace treefarm
