// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Bidirectional path tracing: a path from the camera and one from an emitter for each sample, all pairs of whose
/// vertices are connected (docs/design/transport.md). It finds what path tracing and light tracing find.
RenderUnit prepare_bidirectional(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
