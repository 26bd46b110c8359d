// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "common/base/refuse.h"
#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/plan/schedule/schedule_file.h"
#include "common/runs/run_files.h"
#include "coordinator/render/read_request.h"
#include "coordinator/render/stored_model.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr const char* kKey = "guiding.initial_model";

/// Throws InputError if keys that define a model's densities differ.
void check_guide(const fs::path& run, const Job& before, const Job& now) {
    for (const char* name : {"guiding.type", "guiding.target", "guiding.view_records"}) {
        const JobKey& key = *find_job_key(name);
        if (key.print(before) != key.print(now))
            refuse(run,
                   std::string("its model is another guide's: ") + name + " was \"" + key.print(before) + "\", is \"" +
                       key.print(now) + "\"",
                   std::string("leave ") + kKey + " away, or render both alike");
    }
}

/// Job of an earlier run by this build.
Job job_of(const fs::path& run) {
    try {
        return read_resolved(read_settings_text(run / kResolvedFile, "job"), (run / kResolvedFile).string());
    } catch (const InputError& error) {
        throw InputError(error.where(), std::string(kKey) + " is of another build: " + error.problem(),
                         std::string("render that run again, or leave ") + kKey + " away");
    }
}

}  // namespace

void read_initial_model(RenderRequest& request) {
    Job::Guiding& guiding = request.content.job.guiding;
    const Resolved resolved = resolve(request.content.job, request.content.scene);
    if (guiding.initial_model.empty() || !resolved.guides) return;
    guiding.initial_model = fs::absolute(guiding.initial_model).lexically_normal().string();
    const fs::path run = guiding.initial_model, file = run / kTreeFile;
    if (!fs::exists(run / kResolvedFile) || !fs::exists(run / kScheduleFile))
        refuse(run, "is no run directory", std::string("name one with ") + kKey);
    const Job before = job_of(run);
    check_guide(run, before, resolved);
    const std::vector<PassPlan> passes =
        parse_schedule(read_settings_text(run / kScheduleFile, "schedule"), (run / kScheduleFile).string(), resolved);
    const auto teacher = std::find_if(passes.rbegin(), passes.rend(), [](const PassPlan& pass) { return pass.record; });
    // A run whose passes taught nothing passes on its own initial model.
    const bool has_learned = teacher != passes.rend() || !before.guiding.initial_model.empty();
    if (!fs::exists(file) || !has_learned || !passes.back().guided) {
        request.content.warnings.push_back(run.string() + " has no model to begin with: it " +
                                           (fs::exists(file) ? "gave guiding up" : "has learned none"));
        guiding.initial_model.clear();
        return;
    }
    StoredModel stored =
        read_model(file, guiding.initial_model_hash, "is not the model that guiding.initial_model_hash says");
    guiding.initial_model_hash = stored.hash;
    guiding.initial_model_spp =
        teacher != passes.rend() ? static_cast<int>(teacher->spp) : before.guiding.initial_model_spp;
    request.start.model = std::move(stored.model);
    request.start.model->set_learns_lights(resolved.learns_lights);
    request.start.model->set_decides_next_event(resolved.guides && resolved.decides_next_event);
    request.start.model->set_image({});
}

}  // namespace treefarm
