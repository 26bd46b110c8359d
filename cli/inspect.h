// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm inspect RUN_DIR: statistics and pictures of the tree that a run learned (docs/use/inspect.md).
void add_inspect_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
