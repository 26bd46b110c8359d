// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// All estimators of the program.
std::span<const Integrator> integrators();

/// The job's estimator. Throws RunError for one that the program does not have.
const Integrator& integrator_of(const Job& job);

/// What renders passes of a job, AOVs apart: its integrator; where light subpaths may turn out not to pay, path tracing
/// renders the passes that have none.
RenderUnit prepare(const Resolved& job, const std::shared_ptr<const TraceScene>& scene);

/// The renderer of a job: decodes the scene, builds the hierarchy, makes its integrator ready. Throws RunError for an
/// integrator that the program does not have, and FormatError for a scene that it cannot decode.
RenderUnit make_renderer(std::span<const std::uint8_t> scene, const Job& job);

}  // namespace treefarm
