// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Shading normal n of the first visible surface as the colour (1 + n) / 2; black where the camera sees nothing.
/// Without bumps, and n is not turned towards the camera, so that inverted surfaces are visible.
RenderUnit prepare_normals(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
