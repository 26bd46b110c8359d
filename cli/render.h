// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/on_farm.h"
#include "common/base/log.h"
#include "coordinator/render/read_request.h"
#include "coordinator/render/render.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Options of treefarm render SCENE.xml|JOB.toml
struct RenderOptions {
    std::string input;
    std::string output;                ///< -o
    RenderBudget budget;               ///< --spp, --seconds, --error, --schedule
    std::vector<std::string> set;      ///< --set key=value
    std::vector<std::string> defines;  ///< -D name=value
    std::string sensor;                ///< --sensor
    std::string frames;                ///< --frames
    bool lenient = false;
    std::string run_directory;   ///< --run-dir
    bool overwrite = false;      ///< --overwrite
    bool resume = false;         ///< --resume
    bool carry_model = false;    ///< --carry-model
    std::string display_server;  ///< --display-server
    FarmOptions farm;
    std::string debug_sample;  ///< "pass,x,y,sample"
    std::string command;       ///< as it was typed
};

/// Callback that lets a request resume from the content of its folder. Returns the outcome if the result exists
/// already.
using GoOn = std::function<std::optional<RenderOutcome>(RenderRequest&)>;

/// Renders the request that `read` returns on all processes of the job, whatever this one's role; `name` is shown while
/// it is read. Returns the exit code.
int render_on_farm(const LaunchEnvironment& launch, const FarmOptions& farm, const std::string& name,
                   const std::function<RenderRequest()>& read, const GoOn& go_on = {});

/// Input that the options name. Throws InputError.
RenderInput render_input(const RenderOptions& options);

/// Origin with this program and its command.
RenderOrigin render_origin(const RenderOptions& options);

/// Reads a request, and sets its storage. Throws InputError.
RenderRequest read_request(const RenderOptions& options);

/// Traces the sample or tile `name`, after rendering the passes before its own, which teach the model that guides it
/// (except for those in the request's checkpoint). For a sample, "pass,x,y,sample", prints the path vertex by vertex on
/// standard output; for a tile, "pass,x0,y0,x1,y1,chunk", traces the work unit in this process and thread, for a
/// debugger, and prints its statistics. `tell`: receives error messages. Throws InputError if there is no such sample
/// or tile.
void debug_sample(const RenderRequest& request, const std::string& name, const TellMessage& tell);

/// Options of one frame of a shot: placeholders such as %d are replaced by its number.
RenderOptions frame_options(RenderOptions options, int frame);

/// Folder of a shot.
std::filesystem::path shot_directory(const RenderOptions& options);

/// treefarm render --frames: renders every frame of a shot over all processes. Returns the exit code.
int render_shot(const LaunchEnvironment& launch, const RenderOptions& options);

}  // namespace treefarm
