// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/resume.h"

#include <algorithm>
#include <utility>

#include "common/base/hash.h"
#include "common/base/refuse.h"
#include "common/base/text/parse_text.h"
#include "common/config/job_keys.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/runs/run_files.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/render/finished_render.h"
#include "coordinator/run/run_folder.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

void check_directory(const fs::path& run) {
    check_run_folder(run);
    if (has_checkpoint_file(run)) return;
    refuse_if_at_work(run);
    if (!has_checkpoint_file(run))
        refuse(run, "holds no checkpoint: too little was done, or none was to be kept",
               "render again: treefarm render " + shell_quoted((run / kJobFile).string()));
}

/// Throws InputError if the render could not continue to the same bits. `set`: the settings of --set.
void check_origin(const fs::path& run, const CheckpointOrigin& origin, const RenderRequest& request,
                  const std::vector<std::string>& set) {
    const std::string again = "treefarm render " + shell_quoted((run / kJobFile).string());
    if (origin.fingerprint != request.origin.fingerprint.hash())
        refuse(run,
               "was rendered by another build (" + origin.build + "; this is " + request.origin.fingerprint.text() +
                   "): it could not continue to the same bits",
               "use that program, or: " + again + " --schedule " + shell_quoted((run / kScheduleFile).string()));
    const std::string changed =
        first_difference(read_resolved(origin.resolved, (run / kResolvedFile).string()), request.content.plan.job);
    if (!changed.empty()) {
        std::string new_job = again;
        for (const std::string& argument : set)
            new_job += " --set " + shell_quoted(argument);
        refuse(set.empty() ? run / kJobFile : fs::path("--set"),
               set.empty() ? "is not the job of the render: " + changed : "would make another render: " + changed,
               "only farm.*, output.* and the budget may change; for the new job: " + new_job);
    }
    if (origin.scene_hash != content_hash(encode_scene(request.content.scene)) ||
        origin.pixels != request.content.scene.film.pixel_count())
        refuse(request.content.job.scene.file, "the scene has changed since " + run.string() + " began",
               "resume needs the old files; for the new scene: " + again);
}

/// Whether the budget differs from the stored render's.
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
    // A new budget starts its own plan of the last passes.
    if (has_new_budget(*loaded, request.content.job)) loaded->state.history.budget.ending = false;
    return loaded;
}

/// Whether the run has written all results of `spp` samples.
bool has_written(const fs::path& run, const RenderRequest& request, std::uint32_t spp) {
    const std::string& output = request.content.job.output.file;
    return holds_result(run) && read_figures(run).spp == spp && (output.empty() || fs::exists(output));
}

/// Sets the request up to resume from a checkpoint. Throws InputError if nothing is left to do.
void go_on_from(std::shared_ptr<LoadedCheckpoint> checkpoint, const fs::path& run, RenderRequest& request) {
    request.start.checkpoint = std::move(checkpoint);
    const LoadedCheckpoint& loaded = *request.start.checkpoint;
    if (request.content.schedule.empty() && !has_new_budget(loaded, request.content.job))
        request.content.schedule = loaded.origin.schedule;
    for (const std::string& warning : loaded.warnings)
        request.content.warnings.push_back(warning);
    const std::uint32_t spp = loaded.state.spp();
    if (!loaded.state.partial && !passes_of(request)(loaded.state.history).pass && has_written(run, request, spp))
        refuse(run, "is done (" + std::to_string(spp) + " spp)",
               "add samples with --spp N above that, or --seconds or --error beyond what it has");
}

/// Settings among these that --set gives, or could give.
std::vector<std::string> set_arguments(const std::vector<Setting>& settings) {
    constexpr std::string_view kOption = "--set ";
    std::vector<std::string> arguments;
    for (const Setting& setting : settings)
        if (setting.where.file.starts_with(kOption))
            arguments.push_back(setting.where.file.substr(kOption.size()));
        else if (setting.where.file.empty())
            arguments.push_back(setting.key + "=" + setting.value);
    return arguments;
}

}  // namespace

RenderRequest read_resumed(const fs::path& run, RenderInput input, const RenderOrigin& origin) {
    check_directory(run);
    input.file = (run / kJobFile).string();
    input.reads_model = false;  // the checkpoint contains the model learned from it
    const std::vector<std::string> set = set_arguments(input.settings);
    input.settings.push_back({"output.directory", run.string(), Location{"--run-dir", 0, 0}});
    RenderRequest request = read_request(input, origin);
    auto loaded = load(run, request, set);
    // Lost films are traced again from the first pass on, which that model guides.
    if (!loaded->lost_films.empty()) read_initial_model(request);
    if (request.content.job.output.file.empty()) request.content.job.output.file = loaded->origin.output_file;
    go_on_from(std::move(loaded), run, request);
    return request;
}

void check_run_folder(const fs::path& run) {
    if (fs::exists(run / kJobFile)) return;
    if (fs::is_directory(run)) refuse_if_at_work(run);
    refuse(run, "is no run directory", "name the folder that a render wrote its files to");
}

std::optional<RenderOutcome> go_on_in_folder(RenderRequest& request) {
    const fs::path run = request.content.job.output.directory;
    if (run.empty()) refuse("--resume", "needs a folder to resume in", "name it with --run-dir");
    if (holds_result_of(run, request) && restore_output(run, request.content.job.output.file)) {
        RenderOutcome outcome;
        outcome.state = RunState::done;
        outcome.missed_target = read_figures(run).missed_target;
        outcome.resumable = has_checkpoint_file(run);
        outcome.folder = run;
        return outcome;
    }
    if (has_checkpoint_file(run)) try {
            go_on_from(load(run, request), run, request);
        } catch (const NoCheckpoint& damage) {
            if (holds_result(run) && !request.storage.overwrite) throw;
            request.content.warnings.push_back(damage.where().text() + ": " + damage.problem() +
                                               ": the render begins again");
        } catch (const InputError&) {
            if (!request.storage.overwrite) throw;
            request.start.checkpoint = nullptr;
        }
    // An unfinished render that cannot be resumed is started again.
    request.storage.overwrite = request.storage.overwrite || !holds_result(run);
    return std::nullopt;
}

std::shared_ptr<LoadedCheckpoint> find_checkpoint(const fs::path& run, const RenderRequest& request) {
    if (run.empty()) return nullptr;
    try {
        return load(run, request);
    } catch (const InputError&) {  // the checkpoint only saves time
        return nullptr;
    }
}

}  // namespace treefarm
