// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm keys [PATTERN] [--json]: lists the keys of a job with values, default and meaning. Registers the
/// subcommand; InputError leaves CLI::App::parse.
void add_keys_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
