// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Light that comes straight from emitters to what the camera sees: integrator.emitter_samples of them at each surface,
/// and integrator.bsdf_samples directions of its BSDF, weighed against each other.
RenderUnit prepare_direct(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
