// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolved_file.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/policy_table.h"

namespace treefarm {

std::string job_without_output(Job job) {
    job.output.directory.clear();
    job.output.file.clear();
    return write_job(job);
}

std::string write_resolved(const Resolved& job) {
    return "# The job as it was used: what job.toml leaves to the program has its value here, and so have the tuned\n"
           "# constants. treefarm render resolved.toml repeats the experiment, or says why this build cannot.\n" +
           job_without_output(job) + "\n" + write_policy();
}

Job read_resolved(const std::string& toml, const std::string& name) {
    Job job;
    apply_layer(job, without_policy(parse_job_settings(toml, name)));
    return job;
}

bool may_change_on_resume(const std::string& key) {
    constexpr std::array<std::string_view, 4> kFixed = {"farm.isa", "farm.robust", "output.aovs", "budget.strict"};
    if (std::find(kFixed.begin(), kFixed.end(), key) != kFixed.end()) return false;
    return key.starts_with("budget.") || key.starts_with("farm.") || key.starts_with("output.") ||
           key.starts_with("scene.max_") || key == "scene.root";
}

std::string first_difference(const Job& before, const Job& now) {
    // What follows from another key is named only where that one is the same.
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
