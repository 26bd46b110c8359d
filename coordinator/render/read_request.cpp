// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/read_request.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/base/hash.h"
#include "common/base/text/parse_text.h"
#include "common/config/check_job.h"
#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/plan/schedule/schedule_file.h"
#include "common/scene/pack/scene_codec.h"

namespace treefarm {

namespace {

/// Settings of a budget, which replaces the job's; with spp no other budget is allowed.
std::vector<Setting> budget_layer(const RenderBudget& budget) {
    const auto setting = [](const char* option, const char* key, std::string value) {
        return Setting{key, std::move(value), Location{option, 0, 0}};
    };
    if (!budget.spp && !budget.seconds && !budget.error) return {};
    if (!budget.schedule.empty())
        throw InputError(Location{"--schedule", 0, 0}, "says how long to render, as does another option",
                         "leave --spp, --seconds and --error away");
    if (budget.spp && (budget.seconds || budget.error))
        throw InputError(Location{"--spp", 0, 0}, "cannot stand beside --seconds or --error",
                         "leave it away; to cap the samples, --set budget.max_spp=N");
    std::vector<Setting> layer;
    if (budget.spp) layer.push_back(setting("--spp", "budget.spp", std::to_string(*budget.spp)));
    layer.push_back(setting("--seconds", "budget.seconds", number_text(budget.seconds.value_or(0.0))));
    layer.push_back(setting("--error", "budget.error", number_text(budget.error.value_or(0.0))));
    return layer;
}

/// Refuses budget keys of the settings that another budget overrides, which would be ignored without a message.
void check_budget_keys(const RenderInput& input, RenderContent& content) {
    const Job::Budget& budget = content.job.budget;
    const char* const open = budget.seconds > 0 ? "budget.seconds" : budget.error > 0 ? "budget.error" : nullptr;
    for (const Setting& setting : input.settings) {
        if (!setting.key.starts_with("budget.")) continue;
        if (!input.budget.schedule.empty() && setting.key != "budget.strict")
            throw InputError(setting.where, "--schedule says how long to render", "leave one of them away");
        if (setting.key == "budget.spp" && open != nullptr)
            throw InputError(setting.where, std::string(open) + " decides how many samples there are",
                             "to cap them, --set budget.max_spp=N; to have them instead, --spp N");
        if (setting.key == "budget.max_spp" && open == nullptr)
            content.warnings.emplace_back("budget.max_spp has no effect without --seconds or --error");
    }
}

/// Sets the passes of a schedule file in place of the job's budget.
void replay(const std::string& file, RenderContent& content) {
    content.schedule = parse_schedule(read_settings_text(file, "schedule"), file, resolve(content.job, content.scene));
    content.job.budget.seconds = content.job.budget.error = 0;
    content.job.budget.spp = content.schedule.back().first_sample + content.schedule.back().spp;
}

/// Schedule file of a job file with listed passes, unless the input has a budget. `above`: all of its settings.
std::string schedule_of(const RenderInput& input, const JobFile& file, const std::vector<Setting>& above) {
    const bool has_budget = std::any_of(above.begin(), above.end(), [](const Setting& s) {
        return s.key.starts_with("budget.") && s.key != "budget.strict";
    });
    if (!input.budget.schedule.empty() || has_budget || !file.experiment) return input.budget.schedule;
    if (file.experiment->schedule.empty()) {
        for (const Setting& s : file.settings)
            if ((s.key == "budget.seconds" || s.key == "budget.error") && s.value != "0")
                throw InputError(s.where,
                                 s.key + " chose the passes, but experiment.schedule does not say where they are",
                                 "give that line back, name them with --schedule FILE, or say how long with --spp N");
        return "";
    }
    const std::filesystem::path schedule = std::filesystem::path(input.file).parent_path() / file.experiment->schedule;
    if (!std::filesystem::exists(schedule))
        throw InputError(file.experiment->schedule_where,
                         "its passes are those of " + schedule.string() + ", which is not there",
                         "name it with --schedule FILE, or say how long to render with --spp N");
    return schedule.string();
}

/// Setting that changes the scene: "-D width", or "".
std::string scene_change(const std::vector<Setting>& settings) {
    constexpr std::string_view kDefine = "scene.defines.";
    for (const Setting& s : settings) {
        if (s.key.starts_with(kDefine)) return "-D " + s.key.substr(kDefine.size());
        if (s.key.starts_with("scene.") || s.key.starts_with("image.") || s.key.starts_with("effects."))
            return s.where.file;
    }
    return "";
}

}  // namespace

Job merged_job(const LoadedScene& loaded, std::initializer_list<std::span<const Setting>> layers) {
    Job job;
    apply_layer(job, scene_layer(loaded.settings, layers));
    for (const std::span<const Setting> layer : layers)
        apply_layer(job, layer);
    return job;
}

void take_warnings(const LoadedScene& loaded, RenderContent& content) {
    for (const Warning& warning : loaded.warnings)
        content.warnings.push_back(warning.text());
    for (const Warning& note : loaded.notes)
        content.notes.push_back(note.text());
}

RenderRequest read_request(const RenderInput& input, const RenderOrigin& origin) {
    require_scene_or_job(input.file);
    const std::filesystem::path path(input.file);
    JobFile file;
    std::vector<Setting>& file_layer = file.settings;
    if (path.extension() == ".toml")
        file = checked_job_file(read_job_settings(path));
    else
        file_layer.push_back({"scene.file", std::filesystem::absolute(path).string(), Location{input.file, 0, 0}});
    std::vector<Setting> layer = input.settings;
    const std::vector<Setting> budget = budget_layer(input.budget);
    layer.insert(layer.end(), budget.begin(), budget.end());

    Job where;  // the upper layers name the scene, and how to read it
    apply_layer(where, file_layer);
    apply_layer(where, layer);
    if (where.scene.file.empty())
        throw InputError(Location{input.file, 0, 0}, "the job names no scene", "set scene.file");
    LoadedScene loaded = load_scene(where.scene.file, where.scene.defines, where.scene.lenient, where.image.width,
                                    where.image.height, where.scene.sensor, scene_limits(where.scene));

    RenderRequest request{.origin = origin};
    RenderContent& content = request.content;
    content.job = merged_job(loaded, {file_layer, layer});
    check_job(content.job);
    check_budget_keys(input, content);
    // --set scene.file=... is relative to the current folder, a name in job.toml to that file's folder.
    content.job.scene.file = std::filesystem::absolute(content.job.scene.file).lexically_normal().string();
    content.scene = std::move(loaded.scene);
    if (const std::string schedule = schedule_of(input, file, layer); !schedule.empty()) replay(schedule, content);
    if (input.reads_model) read_initial_model(request);
    content.plan = plan_effects(content.scene, content.job);
    if (file.experiment && input.holds_to_scene)
        require_scene(*file.experiment, hash_text(content_hash(encode_scene(content.scene))), kProgramVersion,
                      scene_change(layer));
    content.plan.passes_guessed |= !content.schedule.empty();
    take_warnings(loaded, content);
    const PassPlan last = plan_passes(content.plan.job).back();
    if (const std::uint32_t spp = last.first_sample + last.spp;
        !content.plan.passes_guessed && spp != static_cast<std::uint32_t>(content.job.budget.spp))
        content.warnings.push_back(
            std::to_string(content.job.budget.spp) + " spp become " + std::to_string(spp) +
            ": passes take multiples of guiding.spp_unit = " + std::to_string(content.job.guiding.spp_unit));
    content.plan.warnings = content.warnings;  // replacements by the reader belong to the plan, too
    return request;
}

}  // namespace treefarm
