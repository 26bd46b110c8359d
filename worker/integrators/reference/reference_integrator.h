// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/contract.h"

namespace treefarm {

/// Unguided path tracing, one path at a time: the code to read first, and the reference for the other estimators. It
/// uses the random numbers of the unguided batch walk (path/path_walk.h).
RenderUnit prepare_reference(std::shared_ptr<const TraceScene> scene, const Resolved& job);

}  // namespace treefarm
