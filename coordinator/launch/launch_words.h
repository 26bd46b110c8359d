// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/launch/launch_run.h"

namespace treefarm {

/// The command of a launch as it was typed, up to "--"; the user repeats it to resume.
std::string launch_words(const LaunchOptions& options);

}  // namespace treefarm
