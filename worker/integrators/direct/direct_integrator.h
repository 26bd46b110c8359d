// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Direct light at the first visible surface: integrator.emitter_samples emitter samples and integrator.bsdf_samples
/// BSDF samples, combined by multiple importance sampling.
RenderUnit prepare_direct(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
