// SPDX-License-Identifier: Apache-2.0
#include "cli/render.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/observer.h"
#include "cli/option_values.h"
#include "coordinator/render/render_series.h"
#include "coordinator/render/resume.h"
#include "coordinator/run/folder_content.h"
#include "coordinator/shot/frames.h"
#include "coordinator/words/reading_notice.h"

namespace treefarm {

namespace {

/// Runs --debug-sample, in one process.
void debug(const LaunchEnvironment& launch, const RenderOptions& options) {
    if (launch.rank != 0) return;
    if (launch.under_mpi)
        throw InputError(Location{"--debug-sample", 0, 0}, "traces one sample in one process", "leave mpirun away");
    RenderRequest request = read_request(options);
    request.start.checkpoint = find_checkpoint(options.run_directory, request);
    const LogOutput log_output = errors_only();
    request.workers.local = local_worker(0, log_output);
    debug_sample(request, options.debug_sample, console_messages("treefarm", log_output.console, log_output.verbosity));
}

}  // namespace

int render_on_farm(const LaunchEnvironment& launch, const FarmOptions& farm, const std::string& name,
                   const std::function<RenderRequest()>& read, const GoOn& go_on) {
    if (is_separate_world(launch)) return 2;
    RenderRequest request;
    std::optional<RenderOutcome> there;
    FarmTask task;
    const LogOutput log_output = make_log_output(launch, farm);
    task.prepare = [&] {
        if (launch.life) launch.life->enter(LifePhase::scene);
        const ReadingNotice notice(log_output.console, name);
        request = read();
        if (go_on) there = go_on(request);
        warn_if_crowded(farm.threads, request.content.warnings);
    };
    task.coordinate = [&](const RenderWorkers& workers) -> CoordinatorEnd {
        if (there) {
            make_log("treefarm", {}, log_output.console, log_output.verbosity)
                ->info("{} holds this render already: {}", there->folder.string(), render_words(there->folder));
            return {exit_code_of(there->state, there->missed_target), {}};
        }
        request.workers = workers;
        if (launch.life) request.origin.attempt = launch.life->attempt();
        request.origin.launch_warnings = launch.warnings;
        Progress shown(log_output.console, request.content.job.budget);
        const RenderObserver observer = make_observer(log_output, launch.life);
        const RenderOutcome outcome = render(request, shown_by(shown, observer));
        return {exit_code_of(outcome.state, outcome.missed_target), outcome.lost_peers};
    };
    return run_on_farm(launch, farm, log_output, task);
}

void add_render_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code) {
    const auto options = std::make_shared<RenderOptions>();
    options->command = command_line;
    CLI::App* command = app.add_subcommand("render", "Renders a scene, under mpirun on all its processes");
    command->add_option("input", options->input, "Mitsuba scene (.xml) or job (.toml)")->required();
    add_text_option(*command, "-o,--output", options->output,
                    "also write the image here: an .exr file, or a .png to look at (image.exr is "
                    "in the run directory in any case)");
    add_samples_option(*command, options->budget.spp,
                       "samples per pixel, rounded up to whole passes' units (default: 64)");
    add_seconds_option(*command, "--seconds", options->budget.seconds, "seconds of rendering; 2min and 1h, too");
    add_error_option(*command, options->budget.error, "stop at this RMSE / mean luminance: 0.05, or 5%");
    add_text_option(*command, "--schedule", options->budget.schedule, "repeat the passes of this schedule.toml");
    add_texts_option(*command, "--set", options->set, "key=value: sets a key of the job (treefarm keys lists them)");
    add_texts_option(*command, "-D", options->defines, "name=value: gives $name in the scene a value");
    add_text_option(*command, "--sensor", options->sensor, "which of several sensors, by number from 0 on or by id");
    add_text_option(*command, "--frames", options->frames,
                    "1-24, 1-24x2 or 1,5,9-12: a shot, whose frames' numbers stand for %d or %04d in the input, -D and "
                    "--set, and for #### in -o");
    command->add_flag("--carry-model", options->carry_model,
                      "of a shot: each frame begins with what the one before has learned");
    command->add_flag("--lenient", options->lenient, "replace unknown elements of the scene instead of refusing them");
    add_text_option(*command, "--run-dir", options->run_directory, "where results go (default: runs/<scene>-<time>)");
    command->add_flag("--overwrite", options->overwrite,
                      "replace the render that the folder holds, once this one is done");
    command->add_flag("--resume", options->resume,
                      "resume this render from the folder's content, if there is any; a finished one is kept");
    add_display_option(*command, options->display_server);
    add_farm_options(*command, options->farm);
    add_text_option(*command, "--debug-sample", options->debug_sample,
                    "pass,x,y,sample: print one path, vertex by vertex; pass,x0,y0,x1,y1,chunk: trace one tile");
    command->footer(std::string(kDefaultsText) + "\n" + kExitCodesText);
    command->callback([options, launch, &exit_code] {
        const auto read = [&] {
            RenderRequest request = read_request(*options);
            if (const std::string& file = request.content.job.output.file; output_names_frame(file))
                request.content.warnings.push_back("-o " + file +
                                                   ": #### and %d stand for a frame's number with --frames only: the "
                                                   "file gets just this name");
            return request;
        };
        if (options->carry_model && options->frames.empty())
            throw InputError(Location{"--carry-model", 0, 0},
                             "carries models from frame to frame, and there is one image",
                             "add --frames, or write --set guiding.initial_model=RUN_DIR");
        if (!options->frames.empty())
            exit_code = render_shot(launch, *options);
        else if (!options->debug_sample.empty())
            debug(launch, *options);
        else
            exit_code = render_on_farm(launch, options->farm, std::filesystem::path(options->input).stem().string(),
                                       read, options->resume ? GoOn(go_on_in_folder) : GoOn());
    });
}

}  // namespace treefarm
