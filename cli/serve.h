// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm serve RUN_DIR|FOLDER: registers the subcommand. Its callback serves until a signal comes, then stores 0;
/// InputError leaves CLI::App::parse.
void add_serve_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
