// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve/resolved_file.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/resolve/policy_table.h"

namespace treefarm {

namespace {

constexpr std::string_view kExperiment = "experiment.";

const Setting* find(const std::vector<Setting>& settings, std::string_view key) {
    const auto found = std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.key == key; });
    return found == settings.end() ? nullptr : &*found;
}

Experiment read_experiment(const std::vector<Setting>& settings, const Location& file) {
    constexpr std::array<std::string_view, 4> kNames = {"version", "results", "scene_hash", "schedule"};
    for (const Setting& setting : settings)
        if (setting.key.starts_with(kExperiment) &&
            std::find(kNames.begin(), kNames.end(), setting.key.substr(kExperiment.size())) == kNames.end())
            throw InputError(setting.where, setting.key + " is nothing that this build knows", kResolvedCure);
    const auto required = [&](std::string_view name) -> const Setting& {
        const std::string key = std::string(kExperiment) + std::string(name);
        if (const Setting* found = find(settings, key)) return *found;
        throw InputError(file, key + " is not in it: the build that wrote it did not tell, or it was taken out",
                         kResolvedCure);
    };
    Experiment experiment{required("version").value, required("scene_hash").value};
    experiment.where = required("scene_hash").where;
    if (const Setting& results = required("results"); results.value != std::to_string(kResults))
        throw InputError(results.where,
                         results.key + " was " + results.value + ", and is " + std::to_string(kResults) +
                             " in this build: equal jobs render to other images than by version " + experiment.version,
                         kResolvedCure);
    if (const Setting* schedule = find(settings, std::string(kExperiment) + "schedule")) {
        experiment.schedule = schedule->value;
        experiment.schedule_where = schedule->where;
    }
    return experiment;
}

}  // namespace

std::string job_without_output(Job job) {
    job.output.directory.clear();
    job.output.file.clear();
    return write_job(job);
}

std::string write_resolved(const Resolved& job, const Experiment& experiment) {
    std::string text =
        "# The job as it was used: what job.toml leaves to the program has its value here, and so have the tuned\n"
        "# constants. treefarm render resolved.toml repeats the experiment, or says why this build cannot.\n"
        "[experiment]\nversion = \"" +
        experiment.version + "\"\nresults = " + std::to_string(kResults) + "\nscene_hash = \"" + experiment.scene_hash +
        "\"\n";
    if (!experiment.schedule.empty()) text += "schedule = \"" + experiment.schedule + "\"\n";
    return text + "\n" + job_without_output(job) + "\n" + write_policy();
}

JobFile checked_job_file(std::vector<Setting> settings) {
    const auto is_experiment = [](const Setting& s) { return s.key.starts_with(kExperiment); };
    const auto is_policy = [](const Setting& s) { return s.key.starts_with(kPolicyPrefix); };
    const auto first = std::find_if(settings.begin(), settings.end(),
                                    [&](const Setting& s) { return is_experiment(s) || is_policy(s); });
    if (first == settings.end()) return {std::move(settings), std::nullopt};
    const Location file{first->where.file};
    JobFile sorted;
    sorted.experiment = read_experiment(settings, file);
    check_policy(settings, file);
    for (const JobKey& key : job_keys())
        if (key.stored() && !key.name.starts_with("output.") && find(settings, key.name) == nullptr)
            throw InputError(file, key.name + " is not in it: the build that wrote it had no such key", kResolvedCure);
    std::erase_if(settings, [&](const Setting& s) { return is_experiment(s) || is_policy(s); });
    sorted.settings = std::move(settings);
    return sorted;
}

void require_scene(const Experiment& experiment, const std::string& scene_hash, const std::string& version,
                   const std::string& changed_by) {
    if (scene_hash == experiment.scene_hash) return;
    std::string why = changed_by.empty() ? "the scene has changed since"
                                         : "the scene has changed since, or " + changed_by + " makes another of it";
    if (version != experiment.version)
        why += ", or version " + experiment.version + " read it otherwise than " + version;
    throw InputError(experiment.where,
                     "experiment.scene_hash was " + experiment.scene_hash + ", and is " + scene_hash + " now: " + why,
                     "render job.toml for the scene as it is now, or bring the old files back");
}

Job read_resolved(const std::string& toml, const std::string& name) {
    Job job;
    apply_layer(job, checked_job_file(parse_job_settings(toml, name)).settings);
    return job;
}

bool may_change_on_resume(const std::string& key) {
    constexpr std::array<std::string_view, 4> kFixed = {"farm.isa", "farm.robust", "output.aovs", "budget.strict"};
    if (std::find(kFixed.begin(), kFixed.end(), key) != kFixed.end()) return false;
    return key.starts_with("budget.") || key.starts_with("farm.") || key.starts_with("output.") ||
           key.starts_with("scene.max_") || key == "scene.root";
}

std::string first_difference(const Job& before, const Job& now) {
    // A key that follows from another is reported only if the other is equal.
    const auto follows = [](const JobKey& key) { return key.name == "integrator.light_selection"; };
    for (const bool following : {false, true})
        for (const JobKey& key : job_keys())
            if (follows(key) == following && key.stored() && !may_change_on_resume(key.name) &&
                key.print(before) != key.print(now))
                return key.name + " was \"" + key.print(before) + "\", is \"" + key.print(now) + "\"";
    if (before.scene.defines != now.scene.defines) return "scene.defines";
    return "";
}

}  // namespace treefarm
