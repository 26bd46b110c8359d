#pragma once

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm plan SCENE.xml|JOB.toml: says what a render would simulate, and renders nothing. Registers the subcommand;
/// InputError leaves CLI::App::parse.
void add_plan_command(CLI::App& app, int& exit_code);

}  // namespace treefarm
