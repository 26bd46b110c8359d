// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/on_farm.h"
#include "coordinator/run/render_run.h"

namespace CLI {
class App;
}

namespace treefarm {

/// Options of treefarm resume RUN_DIR
struct ResumeOptions {
    std::string run;                   ///< the run directory
    std::string output;                ///< -o
    std::optional<std::uint32_t> spp;  ///< --spp: in total, including finished samples
    std::optional<double> seconds;     ///< --seconds: in total, including the time before
    std::optional<double> error;       ///< --error
    std::vector<std::string> set;      ///< --set key=value
    std::string display_server;        ///< --display-server
    FarmOptions farm;
    std::string command;  ///< as it was typed
};

/// Registers the subcommand; as add_render_command().
void add_resume_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

/// Throws InputError if a folder is no run directory, or not yet.
void check_run_folder(const std::filesystem::path& run);

/// Reads a run directory's job, its scene and its newest usable checkpoint. Throws InputError, before anything is
/// written, if the render could not continue to the same bits.
RenderRequest read_resumed(const ResumeOptions& options);

/// Lets a request resume from its folder: from the newest usable checkpoint, or from the start without one. Returns the
/// exit code if its result exists already, after restoring a missing output file. Throws InputError if the folder holds
/// another render's checkpoint, unless overwriting is allowed.
std::optional<int> go_on_in_folder(RenderRequest& request);

/// Newest usable checkpoint of this render in a run directory; nullptr if there is none.
std::shared_ptr<LoadedCheckpoint> find_checkpoint(const std::filesystem::path& run, const RenderRequest& request);

}  // namespace treefarm
