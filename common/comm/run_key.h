// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/comm/join_ticket.h"

namespace treefarm {

/// Name of the file with the secret of an attempt's processes, beside its sign of life.
inline constexpr const char* kRunKeyName = "key";

/// Draws a secret and writes it to a file for this user's processes on all hosts that share it. Throws FileError.
void write_run_key(const std::filesystem::path& path);

/// The secret in a file. Throws InputError if it is missing or not readable by this user alone.
JoinKey read_run_key(const std::filesystem::path& path);

}  // namespace treefarm
