// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/host.h"
#include "common/plan/forecast/memory.h"
#include "coordinator/farm/roster.h"

namespace treefarm {

/// Throws InputError, with the way to go on regardless, where the processes of a host are expected to take more memory
/// than it has: the kernel would end one of them, or all, in mid-render. `own`: the coordinator's host, as it was
/// measured with the scene already read. `roster`: the workers, with what they said of theirs. What is not known is
/// not held against anybody.
void check_memory(const MemoryPlan& plan, const Host& own, const Roster& roster, const std::string& scene);

}  // namespace treefarm
