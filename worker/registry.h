// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// All estimators of the program.
std::span<const Integrator> integrators();

/// Estimator of the job. Throws RunError if the program has none of that name.
const Integrator& integrator_of(const Job& job);

/// Renderer of a job's passes, without AOVs: its integrator, or path tracing for passes without light subpaths, where
/// these may turn out not to pay.
RenderUnit prepare(const Resolved& job, const std::shared_ptr<const TraceScene>& scene);

/// Renderer of a job: decodes the scene, builds the hierarchy, prepares the integrator. Throws RunError for an unknown
/// integrator, and FormatError for a scene that it cannot decode.
RenderUnit make_renderer(std::span<const std::uint8_t> scene, const Job& job);

}  // namespace treefarm
