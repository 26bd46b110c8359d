// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli/exit_code.h"
#include "cli/observer.h"
#include "cli/render.h"
#include "common/base/refuse.h"
#include "common/config/job_reader.h"
#include "common/runs/run_files.h"
#include "coordinator/shot/frame_record.h"
#include "coordinator/shot/frames.h"
#include "coordinator/shot/shot_run.h"

namespace treefarm {

namespace {

/// Run directory of the model with which a frame begins: that of an earlier start, if there was one; else that of the
/// nearest earlier frame with a model. Empty: none.
std::string carried_model(const Shot& shot, int frame) {
    if (const std::filesystem::path own = shot.directory / frame_folder(frame) / kJobFile; std::filesystem::exists(own))
        return read_job_file(own).guiding.initial_model;
    const auto end = std::find(shot.frames.begin(), shot.frames.end(), frame);
    for (auto before = end; before != shot.frames.begin();) {
        const std::filesystem::path folder = shot.directory / frame_folder(*--before);
        if (std::filesystem::exists(folder / kTreeFile)) return folder.string();
    }
    return "";
}

RenderRequest frame_request(const RenderOptions& shot_options, const Shot& shot, int frame,
                            const std::string& attempt) {
    RenderOptions options = frame_options(shot_options, frame);
    if (options.carry_model)
        if (const std::string model = carried_model(shot, frame); !model.empty())
            options.set.push_back("guiding.initial_model=" + model);
    RenderRequest request = read_request(options);
    request.origin.attempt = attempt;
    std::string& file = request.content.job.output.file;  // of -o, --set or the job
    file = output_for_frame(file, frame);
    return request;
}

void check(const RenderOptions& options, std::size_t frame_count) {
    if (!options.debug_sample.empty())
        refuse("--debug-sample", "traces one sample of one render", "leave --frames away, and give -D its value");
    if (!options.budget.schedule.empty())
        refuse("--schedule", "repeats the passes of one render", "leave it or --frames away");
    if (names_frame(options.run_directory))
        refuse("--run-dir", "is the folder of all frames, each of which gets one in it", "leave %d away");
    if (frame_count > 1 && !options.output.empty() && !output_names_frame(options.output))
        refuse("-o", "all frames would be written to " + options.output,
               "write #### where the frame's number belongs, as in frame.####.exr");
}

/// Whether frames can differ.
bool varies(const RenderOptions& options) {
    const auto named = [](const std::vector<std::string>& texts) {
        return std::any_of(texts.begin(), texts.end(), [](const std::string& text) { return names_frame(text); });
    };
    return names_frame(options.input) || names_frame(options.sensor) || named(options.set) || named(options.defines);
}

}  // namespace

RenderOptions frame_options(RenderOptions options, int frame) {
    const auto put = [frame](std::string& text) { text = for_frame(text, frame); };
    put(options.input);
    put(options.sensor);
    std::for_each(options.set.begin(), options.set.end(), put);
    std::for_each(options.defines.begin(), options.defines.end(), put);
    return options;
}

std::filesystem::path shot_directory(const RenderOptions& options) {
    if (!options.run_directory.empty()) return options.run_directory;
    return std::filesystem::path("runs") /
           (name_without_frame(std::filesystem::path(options.input).stem().string()) + "-shot");
}

int render_shot(const LaunchEnvironment& launch, const RenderOptions& options) {
    if (is_separate_world(launch)) return 2;
    Shot shot;
    FarmTask task;
    const LogOutput log_output = make_log_output(launch, options.farm);
    const Log log = make_log("treefarm", {}, log_output.console, log_output.verbosity);
    const std::string attempt = launch.life ? launch.life->attempt() : "";
    task.prepare = [&] {
        shot.frames = parse_frames(options.frames, Location{"--frames", 0, 0});
        check(options, shot.frames.size());
        shot.directory = shot_directory(options);
        shot.read_request = [&](int frame) { return frame_request(options, shot, frame, attempt); };
        std::vector<std::string> warnings;
        warn_if_crowded(options.farm.threads, warnings);
        if (shot.frames.size() > 1 && !varies(options))
            warnings.emplace_back("nothing changes from frame to frame: write -D name=%d to give the scene its number");
        for (const std::string& warning : warnings)
            log->warn("{}", warning);
    };
    task.coordinate = [&](const RenderWorkers& workers) -> CoordinatorEnd {
        SeriesContext series = make_series(render_origin(options), workers, log_output, log, launch.life);
        series.overwrite = options.overwrite;
        const ShotOutcome outcome = run_shot(shot, series);
        return {exit_code_of(outcome.state, outcome.missed_target), outcome.lost_peers};
    };
    return run_on_farm(launch, options.farm, log_output, task);
}

}  // namespace treefarm
