// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

// Each function registers a subcommand, whose callback runs it and stores the exit code; InputError and RunError leave
// CLI::App::parse. `command_line`: as it was typed.

/// treefarm render SCENE.xml|JOB.toml. Errors leave it after the job's other processes were dismissed.
void add_render_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

/// treefarm resume RUN_DIR; as add_render_command().
void add_resume_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

/// treefarm launch ... -- COMMAND: supervises the command.
void add_launch_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm join RUN_DIR: runs workers of a render.
void add_join_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm serve RUN_DIR|FOLDER: serves until a signal comes, then stores 0.
void add_serve_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm plan SCENE.xml|JOB.toml: describes what a render would simulate and, with a budget, its expected cost from
/// a probe of a few seconds. Writes no file.
void add_plan_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm check SCENE.xml: reports risks in a scene, with file positions. Exit code: 0 only notes; 5 a render accepts
/// the scene, but there are risks; 2 a render refuses it.
void add_check_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm compare IMAGE.exr REFERENCE.exr: run_compare() to standard output.
void add_compare_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm convert IMAGE.exr OUT.png: run_convert().
void add_convert_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm inspect RUN_DIR: statistics and pictures of a run's learned tree (docs/use/inspect.md).
void add_inspect_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

/// treefarm study STUDY.toml: runs a matrix of renders and reports on it.
void add_study_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line, int& exit_code);

/// treefarm report FOLDER: rewrites tables and page of a study, complete or not.
void add_report_command(CLI::App& app, const LaunchEnvironment& launch);

/// treefarm keys [PATTERN] [--json]: lists a job's keys with values, default and meaning.
void add_keys_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
