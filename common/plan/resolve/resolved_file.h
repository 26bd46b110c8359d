// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/config/setting.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Version of results: to be raised by an intentional change of what equal jobs and scenes render to, so that files of
/// earlier builds are refused. Changes of constants of policy.h are detected without it. tests/tools/same_images shows
/// whether images have changed.
inline constexpr int kResults = 2;

/// The render that a resolved.toml describes: its section [experiment].
struct Experiment {
    std::string version;     ///< of the program that wrote it
    std::string scene_hash;  ///< as in summary.json
    std::string schedule{};  ///< file beside it that lists the passes; "": they follow from the job
    Location where{};        ///< of the scene's hash in the file, for messages
    Location schedule_where{};
};

/// Content of a job file. Only a resolved.toml has an experiment.
struct JobFile {
    std::vector<Setting> settings;  ///< of the job
    std::optional<Experiment> experiment;
};

/// The job without the keys of output files, which are not part of a job to be repeated; the keys of their content
/// stay.
std::string job_without_output(Job job);

/// Text of the file resolved.toml: the experiment, the resolved job, and the constants of policy.h.
std::string write_resolved(const Resolved& job, const Experiment& experiment = {});

/// Divides the settings of a file into job and experiment. A file with [experiment] or [policy] is a resolved.toml: it
/// must have the whole experiment, each constant with this build's value, and each key of a job. Throws InputError,
/// which names the first that is missing or differs.
JobFile checked_job_file(std::vector<Setting> settings);

/// Throws InputError if the job's scene is not that of the experiment. `version`: of this program; `changed_by`: an
/// option that may have changed the scene, such as "-D width", or "".
void require_scene(const Experiment& experiment, const std::string& scene_hash, const std::string& version,
                   const std::string& changed_by);

/// Job from the text of a resolved.toml, which must be complete.
Job read_resolved(const std::string& toml, const std::string& name);

/// Whether a render may be resumed with another value of this key: its bits do not depend on it, or it is about the
/// length.
bool may_change_on_resume(const std::string& key);

/// First key in which two jobs differ and that may not change, as text: "guiding.type was \"auto\", is \"none\""; "" if
/// there is none.
std::string first_difference(const Job& before, const Job& now);

}  // namespace treefarm
