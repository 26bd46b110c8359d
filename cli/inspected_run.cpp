// SPDX-License-Identifier: Apache-2.0
#include "cli/inspected_run.h"

#include <algorithm>

#include "common/base/hash.h"
#include "common/base/refuse.h"
#include "common/config/job_reader.h"
#include "common/plan/schedule/schedule_file.h"
#include "common/runs/run_json.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/render/stored_model.h"

namespace treefarm {

namespace {

void check_directory(const std::filesystem::path& directory) {
    if (!std::filesystem::is_directory(directory))
        refuse(directory, "is no run directory", "name the folder that a render wrote its files to");
    if (!std::filesystem::exists(directory / kJobFile))
        refuse(directory / kJobFile, "is missing, so this is no run directory",
               "name the folder that a render wrote its files to");
    if (!std::filesystem::exists(directory / kSummaryFile))
        refuse(directory / kSummaryFile, "is missing, so the run has not come to its end",
               "wait for it, or render again");
}

/// Text value of a key in summary.json.
std::string summary_text(const RunJson& summary, const std::filesystem::path& file, RunKey key) {
    if (!text_of(summary, key).is_string())
        refuse(file, std::string("lacks ") + key.name() + ", so another version wrote it", "render again");
    return text_in(summary, key);
}

StoredModel read_tree(const std::filesystem::path& file, const std::string& expected_hash, const Job& job) {
    if (!std::filesystem::exists(file)) {
        if (job.guiding.type == GuidingType::none)
            refuse(file, "is missing, since guiding.type is \"none\": the run has no tree",
                   "render with --set guiding.type=auto");
        if (expected_hash.empty())
            refuse(file, "is missing, since no pass had taught the tree when the run ended",
                   "render more samples, so that there are at least two passes");
        refuse(file, "is missing, though the run wrote it", "render again");
    }
    constexpr const char* kOther = "is not the tree that summary.json stands beside: it is of another run, or damaged";
    if (expected_hash.empty()) refuse(file, kOther, "render again");
    return read_model(file, expected_hash, kOther);
}

}  // namespace

InspectedRun read_inspected_run(const std::filesystem::path& directory) {
    check_directory(directory);
    const std::filesystem::path job = directory / kJobFile, summary_file = directory / kSummaryFile;
    const RunJson summary = read_run_json(summary_file);
    if (summary.empty()) refuse(summary_file, "is not what a render writes", "render again");
    InspectedRun run;
    run.directory = directory;
    StoredModel stored =
        read_tree(directory / kTreeFile, summary_text(summary, summary_file, "tree_file_hash"), read_job_file(job));
    run.tree = std::move(stored.model);
    run.tree_bytes = stored.bytes;
    run.request = read_request({.file = job.string()}, {});
    if (hash_text(content_hash(encode_scene(run.request.content.scene))) !=
        summary_text(summary, summary_file, "scene_hash"))
        refuse(run.request.content.job.scene.file,
               "is not the scene that " + job.string() + " rendered: it has changed since", "render again");
    const std::filesystem::path schedule = directory / kScheduleFile;
    const std::vector<PassPlan> passes =
        parse_schedule(read_settings_text(schedule, "schedule"), schedule.string(), run.request.content.plan.job);
    const auto teacher = std::find_if(passes.rbegin(), passes.rend(), [](const PassPlan& pass) { return pass.record; });
    run.taught_by_next_event = teacher != passes.rend() && teacher->next_event;
    return run;
}

}  // namespace treefarm
