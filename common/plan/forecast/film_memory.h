// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/plan/forecast/memory.h"

namespace treefarm {

/// Adds what grows with the image, as it is allocated: results in transit, in workers and coordinator; films, images
/// and files, checkpoints and AOVs, in the coordinator.
void add_film_memory(const Scene& scene, const Resolved& job, MemoryPlan& plan);

}  // namespace treefarm
