// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Light tracing: paths start at emitters, and each vertex is connected to the camera (docs/design/transport.md).
/// Efficient for caustics of small lamps; blind to light that reaches the camera by a mirror or smooth glass.
RenderUnit prepare_light(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
