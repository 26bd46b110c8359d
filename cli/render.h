// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/launch_environment.h"
#include "cli/on_farm.h"
#include "coordinator/run/render_run.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm render SCENE.xml|JOB.toml
struct RenderOptions {
    std::string input;
    std::string output;                ///< -o
    std::optional<std::uint32_t> spp;  ///< --spp
    std::optional<double> seconds;     ///< --seconds
    std::optional<double> error;       ///< --error
    std::string schedule;              ///< --schedule
    std::vector<std::string> set;      ///< --set key=value
    std::vector<std::string> defines;  ///< -D name=value
    std::string sensor;                ///< --sensor
    std::string frames;                ///< --frames
    bool lenient = false;
    std::string run_directory;   ///< --run-dir
    bool overwrite = false;      ///< --overwrite
    bool resume = false;         ///< --resume
    bool carry_model = false;    ///< --carry-model
    bool reads_model = true;     ///< guiding.initial_model is still to be read
    bool holds_to_scene = true;  ///< the scene has to be that of a resolved.toml
    std::string display_server;  ///< --display-server
    FarmOptions farm;
    std::string debug_sample;  ///< "pass,x,y,sample"
    std::string command;       ///< as it was typed
};

/// Registers the subcommand. Its callback runs the render and stores the exit code; InputError and RunError leave
/// CLI::App::parse, after the other processes of the job were sent away.
void add_render_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

/// Lets a request that was read go on with what lies in its folder. Returns the exit code where its result is there.
using GoOn = std::function<std::optional<int>(RenderRequest&)>;

/// Renders what `read` gives on all processes of the job, whatever its part in it; `name` is for the time in which it
/// is read. Returns the exit code.
int render_on_farm(const LaunchEnvironment& launch, const FarmOptions& farm, const std::string& name,
                   const std::function<RenderRequest()>& read, const GoOn& go_on = {});

/// Reads job and scene. The job's layers, each over the one before: defaults, the scene file's integrator and sampler,
/// the job file, the command line. Throws InputError.
RenderRequest read_request(const RenderOptions& options);

/// The command that traces one sample again, but for the sample.
std::string debug_command(const RenderOptions& options);

}  // namespace treefarm
