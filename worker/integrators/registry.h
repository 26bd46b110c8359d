// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// All estimators of the program.
std::span<const Integrator> integrators();

/// The job's estimator. Throws RunError for one that the program does not have.
const Integrator& integrator_of(const Job& job);

/// The renderer of a job: decodes the scene, builds the hierarchy, makes its integrator ready. Throws RunError for an
/// integrator that the program does not have, and FormatError for a scene that it cannot decode.
RenderUnit make_renderer(std::span<const std::uint8_t> scene, const Job& job);

}  // namespace treefarm
