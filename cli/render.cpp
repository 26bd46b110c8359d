#include "cli/render.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/debug_sample.h"
#include "cli/on_farm.h"

namespace treefarm {

namespace {

int exit_code_of(const RenderOutcome& outcome) {
    switch (outcome.state) {
        case RunState::done:
            return outcome.missed_target ? 4 : 0;
        case RunState::interrupted:
            return 3;
        default:
            return 1;
    }
}

int render(const LaunchEnvironment& launch, const RenderOptions& options) {
    RenderRequest request;
    FarmTask task;
    task.prepare = [&] {
        request = read_request(options);
        warn_if_crowded(options.threads, request.warnings);
        request.progress_bar = !options.quiet && isatty(STDERR_FILENO);
    };
    task.coordinate = [&](Channel& channel, const std::function<bool()>& interrupted) -> CoordinatorEnd {
        const RenderOutcome outcome = run_render(channel, request, interrupted);
        return {exit_code_of(outcome), outcome.lost_peers};
    };
    return run_on_farm(launch, options.threads, options.quiet, task);
}

/// A sample is traced in one process.
int debug(const LaunchEnvironment& launch, const RenderOptions& options) {
    if (launch.rank != 0) return 0;
    if (launch.under_mpi)
        throw InputError(Location{"--debug-sample", 0, 0}, "traces one sample in one process", "leave mpirun away");
    return debug_sample(read_request(options), parse_sample_name(options.debug_sample));
}

}  // namespace

void add_render_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code) {
    const auto options = std::make_shared<RenderOptions>();
    options->command = command_line;
    CLI::App* command = app.add_subcommand("render", "Renders a scene, under mpirun on all its processes");
    command->add_option("input", options->input, "Mitsuba scene (.xml) or job (.toml)")->required();
    command->add_option("-o,--output", options->output, "also write the image to this EXR file");
    command->add_option("--spp", options->spp, "samples per pixel, rounded up to whole passes' units");
    command->add_option("--seconds", options->seconds, "seconds of rendering");
    command->add_option("--error", options->error, "stop at this RMSE / mean luminance: 0.05 is 5 %");
    command->add_option("--schedule", options->schedule, "repeat the passes of this schedule.toml");
    command->add_option("--set", options->set, "key=value: sets a key of the job")->allow_extra_args(false);
    command->add_option("-D", options->defines, "name=value: gives $name in the scene a value")
        ->allow_extra_args(false);
    command->add_flag("--lenient", options->lenient, "replace what the scene reader does not know instead of refusing");
    command->add_option("--run-dir", options->run_directory, "where results go (default: runs/<scene>-<time>)");
    command->add_flag("--overwrite", options->overwrite,
                      "replace the render that the folder holds, once this one is done");
    command->add_option("--threads", options->threads, "tracing threads of each process (default: its processors)")
        ->check(CLI::Range(1u, 4096u));
    command->add_flag("--quiet", options->quiet, "only errors on the terminal");
    command->add_option("--debug-sample", options->debug_sample,
                        "pass,x,y,sample: trace this sample and tell its story");
    command->callback([options, launch, &exit_code] {
        exit_code = options->debug_sample.empty() ? render(launch, *options) : debug(launch, *options);
    });
}

}  // namespace treefarm
