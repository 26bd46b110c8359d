// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm check SCENE.xml: reports risks in a scene, with file positions. Registers the subcommand. Exit code: 0 only
/// notes; 5 a render accepts the scene, but there are risks; 2 a render refuses it.
void add_check_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
