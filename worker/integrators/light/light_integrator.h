// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Light tracing: paths that start at emitters, each vertex of which is connected to the camera
/// (docs/design/transport.md). It finds caustics of small lamps, and nothing that the camera sees in a mirror or
/// through smooth glass.
RenderUnit prepare_light(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
