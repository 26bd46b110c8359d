// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/host.h"
#include "common/plan/forecast/memory.h"
#include "coordinator/farm/roster.h"

namespace treefarm {

/// Throws InputError, with the option to proceed anyway, if the processes of a host are expected to need more memory
/// than it has: the kernel would end one of them, or all, during the render. `own`: the coordinator's host, measured
/// with the scene already read. `roster`: the workers, with their reported memory. Unknown values count as sufficient.
void check_memory(const MemoryPlan& plan, const Host& own, const Roster& roster, const std::string& scene);

}  // namespace treefarm
