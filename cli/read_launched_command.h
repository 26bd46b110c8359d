// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/launch/launched_command.h"

namespace treefarm {

/// Parses the words after "--", with the option checks of the command itself. Throws InputError.
LaunchedCommand read_launched_command(const std::vector<std::string>& words);

}  // namespace treefarm
