// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm study STUDY.toml: runs a matrix of renders and reports on it. Registers the subcommand; InputError and
/// RunError leave CLI::App::parse.
void add_study_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line, int& exit_code);

/// treefarm report FOLDER: writes tables and page of a study again, whole or not.
void add_report_command(CLI::App& app, const LaunchEnvironment& launch);

}  // namespace treefarm
