// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/resume.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/render.h"
#include "common/runs/run_files.h"

namespace treefarm {

namespace {

/// Options of treefarm resume RUN_DIR
struct ResumeOptions {
    std::string run;
    RenderOptions render;  ///< of the resumed render
};

RenderRequest read(const ResumeOptions& options) {
    RenderRequest request = read_resumed(options.run, render_input(options.render), render_origin(options.render));
    request.storage.display_server = options.render.display_server;
    return request;
}

}  // namespace

void add_resume_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code) {
    const auto options = std::make_shared<ResumeOptions>();
    RenderOptions& render = options->render;
    render.command = command_line;
    CLI::App* command = app.add_subcommand("resume", "Resumes an unfinished render, or adds samples to a finished one");
    command->add_option("run", options->run, "its run directory")->required();
    add_text_option(*command, "-o,--output", render.output,
                    "also write the image here (default: where the render would have)");
    add_samples_option(*command, render.budget.spp, "samples per pixel in all, those that are done included");
    add_seconds_option(*command, "--seconds", render.budget.seconds,
                       "seconds of rendering in all, those before included");
    add_error_option(*command, render.budget.error, "stop at this RMSE / mean luminance: 0.05, or 5%");
    add_texts_option(*command, "--set", render.set, "key=value: a key of the job that its bits do not depend on");
    add_display_option(*command, render.display_server);
    add_farm_options(*command, render.farm);
    command->footer(
        std::string("Job, scene and build have to be those of the render; processes, threads and budget are "
                    "free.\n") +
        kExitCodesText);
    command->callback([options, launch, &exit_code] {
        const std::filesystem::path run(options->run);
        options->render.input = (run / kJobFile).string();
        exit_code = render_on_farm(launch, options->render.farm, run.filename(), [&] { return read(*options); });
    });
}

}  // namespace treefarm
