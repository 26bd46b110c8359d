// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// Registers the subcommand; as add_render_command().
void add_resume_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

}  // namespace treefarm
