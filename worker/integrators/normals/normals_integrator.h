// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// The shading normal n of what the camera sees, as the colour (1 + n) / 2; black where it sees nothing. Bumps are left
/// out, and n is not turned towards the camera: surfaces that are inside out show.
RenderUnit prepare_normals(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
