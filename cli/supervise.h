// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm launch ... -- COMMAND: registers the subcommand. Its callback keeps the command alive and stores its exit
/// code; InputError leaves CLI::App::parse.
void add_launch_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
