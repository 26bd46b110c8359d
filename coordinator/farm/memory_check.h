// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/base/host.h"
#include "common/plan/forecast/memory.h"
#include "coordinator/farm/roster.h"

namespace treefarm {

/// Bytes that a process has still to allocate when the render begins: all but its program and the coordinator's scene.
std::uint64_t still_to_come(std::span<const MemoryItem> items);

/// Throws InputError, with the option to proceed anyway, if the processes of a host are expected to need more memory
/// than it has: the kernel would end one of them, or all, during the render. `own`: the coordinator's host, measured
/// with the scene already read. `roster`: the workers, with their reported memory, guests apart, which
/// Farm::require_of_guests() checks one by one. Unknown values count as sufficient.
void check_memory(const MemoryPlan& plan, const Host& own, const Roster& roster, const std::string& scene);

}  // namespace treefarm
