// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/comm/join_ticket.h"

namespace treefarm {

/// Name of the file that holds the secret of an attempt's processes, beside their sign of life.
inline constexpr const char* kRunKeyName = "key";

/// Draws a secret and writes it for this user's processes on all hosts that see the file. Throws RunError.
void write_run_key(const std::filesystem::path& path);

/// The secret that a file holds. Throws InputError where there is none that this user alone could read.
JoinKey read_run_key(const std::filesystem::path& path);

}  // namespace treefarm
