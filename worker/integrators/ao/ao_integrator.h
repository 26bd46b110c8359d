// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Ambient occlusion: 1 / pi times the integral of cos over the unoccluded directions, about the shading normal on the
/// camera's side; a surface occludes if it is nearer than integrator.ao_distance. 1 where the camera sees nothing.
RenderUnit prepare_ao(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
