// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/launch/launched_command.h"

namespace treefarm {

/// Reads what stands behind "--", and checks its options as the command itself would. Throws InputError.
LaunchedCommand read_launched_command(const std::vector<std::string>& words);

}  // namespace treefarm
