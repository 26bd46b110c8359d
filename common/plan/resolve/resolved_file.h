// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/config/setting.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Number of what equal jobs and scenes render to. Whoever changes that on purpose raises it, so that files of builds
/// before are refused; a change of a constant of policy.h is seen without. tests/tools/same_images tells whether
/// images have changed.
inline constexpr int kResults = 1;

/// The render that a resolved.toml is of: its section [experiment].
struct Experiment {
    std::string version;     ///< of the program that wrote it
    std::string scene_hash;  ///< as summary.json has it
    std::string schedule{};  ///< file beside it that lists the passes; "": they follow from the job
    Location where{};        ///< of the scene's hash in the file, for messages
    Location schedule_where{};
};

/// What a job file says. Only a resolved.toml has an experiment.
struct JobFile {
    std::vector<Setting> settings;  ///< of the job
    std::optional<Experiment> experiment;
};

/// The job without where it is written: that is no part of a job that somebody repeats; what is written is.
std::string job_without_output(Job job);

/// The file resolved.toml: the experiment, a job as it was used, and the tuned constants.
std::string write_resolved(const Resolved& job, const Experiment& experiment = {});

/// Settings of a file, by what they are. One with [experiment] or [policy] is a resolved.toml: it has to tell all of
/// the experiment, each constant with this build's value, and each key of a job. Throws InputError, which names the
/// first that is missing or differs.
JobFile checked_job_file(std::vector<Setting> settings);

/// Throws InputError where the scene that the job names is not the experiment's. `version`: of this program;
/// `changed_by`: what else than the file may have changed it, "-D width" for one, or "".
void require_scene(const Experiment& experiment, const std::string& scene_hash, const std::string& version,
                   const std::string& changed_by);

/// Budget and farm of a resolved.toml, and its other settings.
Job read_resolved(const std::string& toml, const std::string& name);

/// Whether a render may go on with another value of this key: its bits do not depend on it, or it says how long.
bool may_change_on_resume(const std::string& key);

/// The first key that two jobs differ in and that may not change: "guiding.type was \"auto\", is \"none\""; "" if there
/// is none.
std::string first_difference(const Job& before, const Job& now);

}  // namespace treefarm
