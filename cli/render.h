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

/// Options of treefarm render SCENE.xml|JOB.toml
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
    bool reads_model = true;     ///< guiding.initial_model has not been read yet
    bool holds_to_scene = true;  ///< the scene must be that of the resolved.toml
    std::string display_server;  ///< --display-server
    FarmOptions farm;
    std::string debug_sample;  ///< "pass,x,y,sample"
    std::string command;       ///< as it was typed
};

/// Registers the subcommand. Its callback runs the render and stores the exit code; InputError and RunError leave
/// CLI::App::parse, after the job's other processes were dismissed.
void add_render_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

/// Callback that lets a request resume from the content of its folder. Returns the exit code if the result exists
/// already.
using GoOn = std::function<std::optional<int>(RenderRequest&)>;

/// Renders the request that `read` returns on all processes of the job, whatever this one's role; `name` is shown while
/// it is read. Returns the exit code.
int render_on_farm(const LaunchEnvironment& launch, const FarmOptions& farm, const std::string& name,
                   const std::function<RenderRequest()>& read, const GoOn& go_on = {});

/// Reads job and scene. Layers of the job, each over the previous one: defaults, the scene file's integrator and
/// sampler, the job file, the command line. Throws InputError.
RenderRequest read_request(const RenderOptions& options);

/// Command that traces one sample again, without the sample's name.
std::string debug_command(const RenderOptions& options);

}  // namespace treefarm
