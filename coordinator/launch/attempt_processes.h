// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace treefarm {

/// Processes of this user on this host whose environment names an attempt of treefarm launch: whoever their parents
/// are, and however their launcher ended.
std::vector<pid_t> attempt_processes(const std::string& attempt);

/// Kills them, and waits up to `patience` seconds until they are gone. Returns whether they are.
bool kill_attempt(const std::string& attempt, double patience);

}  // namespace treefarm
