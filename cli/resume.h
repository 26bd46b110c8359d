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

/// treefarm resume RUN_DIR
struct ResumeOptions {
    std::string run;                   ///< the run directory
    std::string output;                ///< -o
    std::optional<std::uint32_t> spp;  ///< --spp: in all, what is done included
    std::optional<double> seconds;     ///< --seconds: in all lives of the render
    std::optional<double> error;       ///< --error
    std::vector<std::string> set;      ///< --set key=value
    std::string display_server;        ///< --display-server
    FarmOptions farm;
    std::string command;  ///< as it was typed
};

/// Registers the subcommand; as add_render_command().
void add_resume_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code);

/// Refuses what is no run directory, or not yet: throws InputError.
void check_run_folder(const std::filesystem::path& run);

/// Reads a run directory's job, its scene and its newest usable checkpoint. Throws InputError where the render cannot
/// go on from there to the same bits; nothing has been written then.
RenderRequest read_resumed(const ResumeOptions& options);

/// Lets a request go on with what the folder that it names holds of it: from its newest usable checkpoint, or from the
/// start where there is none. Returns the exit code where its result is there, and has its output file made if that is
/// missing. Throws InputError where the folder holds a checkpoint of another render, and overwriting is not asked for.
std::optional<int> go_on_in_folder(RenderRequest& request);

/// The newest usable checkpoint of this very render in a run directory; nullptr where there is none.
std::shared_ptr<LoadedCheckpoint> find_checkpoint(const std::filesystem::path& run, const RenderRequest& request);

}  // namespace treefarm
