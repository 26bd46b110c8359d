// SPDX-License-Identifier: Apache-2.0
#include "cli/resume.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "cli/exit_code.h"
#include "cli/option_values.h"
#include "cli/refuse.h"
#include "cli/render.h"
#include "common/base/hash.h"
#include "common/config/job_keys.h"
#include "common/config/parse_text.h"
#include "common/plan/resolved_file.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/run_folder.h"
#include "coordinator/shot/finished_frame.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

void check_directory(const fs::path& run) {
    check_run_folder(run);
    if (!fs::exists(run / kCheckpointFolder)) refuse_if_at_work(run);
    if (!fs::exists(run / kCheckpointFolder))
        refuse(run, "holds no checkpoint: too little was done, or none was to be kept",
               "render again: treefarm render " + shell_quoted((run / "job.toml").string()));
}

/// Refuses what would not go on to the same bits. `set`: what --set gives.
void check_origin(const fs::path& run, const CheckpointOrigin& origin, const RenderRequest& request,
                  const std::vector<std::string>& set) {
    const std::string again = "treefarm render " + shell_quoted((run / "job.toml").string());
    if (origin.fingerprint != request.fingerprint.hash())
        refuse(run,
               "was rendered by another build (" + origin.build + "; this is " + request.fingerprint.text() +
                   "): its bits could not go on",
               "use that program, or: " + again + " --schedule " + shell_quoted((run / "schedule.toml").string()));
    const std::string changed =
        first_difference(read_resolved(origin.resolved, (run / "resolved.toml").string()), request.plan.job);
    if (!changed.empty()) {
        std::string new_job = again;
        for (const std::string& argument : set)
            new_job += " --set " + shell_quoted(argument);
        refuse(set.empty() ? run / "job.toml" : fs::path("--set"),
               set.empty() ? "is not the job of the render: " + changed : "would make another render: " + changed,
               "only farm.*, output.* and the budget may change; for the new job: " + new_job);
    }
    if (origin.scene_hash != content_hash(encode_scene(request.scene)) ||
        origin.pixels != request.scene.film.pixel_count())
        refuse(request.job.scene.file, "the scene has changed since " + run.string() + " began",
               "resume needs the old files; for the new scene: " + again);
}

/// Whether the render was asked for by another budget.
bool has_new_budget(const LoadedCheckpoint& loaded, const Job& now) {
    const Job before = read_resolved(loaded.origin.resolved, "the checkpoint");
    const auto keys = job_keys();
    return std::any_of(keys.begin(), keys.end(), [&](const JobKey& key) {
        return key.name.starts_with("budget.") && key.print(before) != key.print(now);
    });
}

std::shared_ptr<LoadedCheckpoint> load(const fs::path& run, const RenderRequest& request,
                                       const std::vector<std::string>& set = {}) {
    auto loaded = std::make_shared<LoadedCheckpoint>(
        load_checkpoint(run, [&](const CheckpointOrigin& origin) { check_origin(run, origin, request, set); }));
    // A new budget starts its own reckoning of how to end.
    if (has_new_budget(*loaded, request.job)) loaded->state.history.budget.ending = false;
    return loaded;
}

/// Whether the run has written all that these samples give.
bool has_written(const fs::path& run, const RenderRequest& request, std::uint32_t spp) {
    FrameRecord record;
    read_figures(run, record);
    const std::string& output = request.job.output.file;
    return holds_result(run) && record.spp == spp && (output.empty() || fs::exists(output));
}

/// Goes on from what was loaded. Throws InputError where nothing is left to do.
void go_on_from(std::shared_ptr<LoadedCheckpoint> checkpoint, const fs::path& run, RenderRequest& request) {
    request.resumed = std::move(checkpoint);
    const LoadedCheckpoint& loaded = *request.resumed;
    if (request.schedule.empty() && !has_new_budget(loaded, request.job)) request.schedule = loaded.origin.schedule;
    for (const std::string& warning : loaded.warnings)
        request.warnings.push_back(warning);
    const std::uint32_t spp = loaded.state.spp();
    if (!loaded.state.partial && !passes_of(request)(loaded.state.history).pass && has_written(run, request, spp))
        refuse(run, "is done (" + std::to_string(spp) + " spp)",
               "add samples with --spp N above that, or --seconds or --error beyond what it has");
}

}  // namespace

RenderRequest read_resumed(const ResumeOptions& options) {
    const fs::path run(options.run);
    check_directory(run);
    RenderOptions as_render;
    as_render.input = (run / "job.toml").string();
    as_render.run_directory = options.run;
    as_render.output = options.output;
    as_render.spp = options.spp;
    as_render.seconds = options.seconds;
    as_render.error = options.error;
    as_render.set = options.set;
    as_render.command = options.command;
    as_render.display_server = options.display_server;
    as_render.reads_model = false;  // the checkpoint has what became of it
    RenderRequest request = read_request(as_render);
    auto loaded = load(run, request, options.set);
    if (request.job.output.file.empty()) request.job.output.file = loaded->origin.output_file;
    go_on_from(std::move(loaded), run, request);
    return request;
}

void check_run_folder(const fs::path& run) {
    if (fs::exists(run / "job.toml")) return;
    if (fs::is_directory(run)) refuse_if_at_work(run);
    refuse(run, "is no run directory", "name the folder that a render wrote its files to");
}

std::optional<int> go_on_in_folder(RenderRequest& request) {
    const fs::path run = request.job.output.directory;
    if (run.empty()) refuse("--resume", "does not know in which folder to go on", "name it with --run-dir");
    if (holds_result_of(run, request) && restore_output(run, request.job.output.file)) {
        FrameRecord record;
        read_figures(run, record);
        return exit_code_of(RunState::done, record.missed_target);
    }
    if (fs::exists(run / kCheckpointFolder)) try {
            go_on_from(load(run, request), run, request);
        } catch (const InputError&) {
            if (!request.overwrite) throw;
            request.resumed = nullptr;
        }
    // What was broken off and cannot go on is begun again.
    request.overwrite = request.overwrite || !holds_result(run);
    return std::nullopt;
}

std::shared_ptr<LoadedCheckpoint> find_checkpoint(const fs::path& run, const RenderRequest& request) {
    if (run.empty() || !fs::exists(run / kCheckpointFolder)) return nullptr;
    try {
        return load(run, request);
    } catch (const InputError&) {  // it only saves time
        return nullptr;
    }
}

void add_resume_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code) {
    const auto options = std::make_shared<ResumeOptions>();
    options->command = command_line;
    CLI::App* command =
        app.add_subcommand("resume", "Goes on with a render that was broken off, or adds samples to it");
    command->add_option("run", options->run, "its run directory")->required();
    add_text_option(*command, "-o,--output", options->output,
                    "also write the image here (default: where the render would have)");
    add_samples_option(*command, options->spp, "samples per pixel in all, those that are done included");
    add_seconds_option(*command, "--seconds", options->seconds, "seconds of rendering in all, those before included");
    add_error_option(*command, options->error, "stop at this RMSE / mean luminance: 0.05, or 5%");
    add_texts_option(*command, "--set", options->set, "key=value: a key of the job that its bits do not depend on");
    add_display_option(*command, options->display_server);
    add_farm_options(*command, options->farm);
    command->footer(
        std::string("Job, scene and build have to be those of the render; processes, threads and budget are "
                    "free.\n") +
        kExitCodesText);
    command->callback([options, launch, &exit_code] {
        exit_code = render_on_farm(launch, options->farm, fs::path(options->run).filename(),
                                   [&] { return read_resumed(*options); });
    });
}

}  // namespace treefarm
