// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Bidirectional path tracing: for each sample a camera subpath and a light subpath, all pairs of whose vertices are
/// connected (docs/design/transport.md). It covers the transport of both path tracing and light tracing.
RenderUnit prepare_bidirectional(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
