// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Guided path tracing in batches (docs/design/speed.md).
RenderUnit prepare_path(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
