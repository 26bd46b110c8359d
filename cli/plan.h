// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm plan SCENE.xml|JOB.toml: says what a render would simulate, and, if asked by a budget, what it would take
/// by a probe of a few seconds. Writes no file. Registers the subcommand; InputError leaves CLI::App::parse.
void add_plan_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
