// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace treefarm {

/// Processes of this user on this host whose environment names an attempt of treefarm launch, whatever their parents
/// and their launcher's end.
std::vector<pid_t> attempt_processes(const std::string& attempt);

/// Kills an attempt's processes, and waits up to `patience` seconds for their end. Returns whether all have ended.
bool kill_attempt(const std::string& attempt, double patience);

}  // namespace treefarm
