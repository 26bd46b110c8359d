// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm check SCENE.xml: says what in a scene is risky, with places. Registers the subcommand. Exit code: 0 nothing
/// but notes, 5 a render takes the scene, but something is risky, 2 a render refuses it.
void add_check_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
