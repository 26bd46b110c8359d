// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/config/setting.h"

namespace treefarm {

/// Sets one key. An unknown key, a value out of range or of the wrong type, and what is not available in this version
/// throw InputError at the setting's place. guiding.preset sets all that the preset stands for.
void apply_setting(Job& job, const std::string& key, const std::string& value, const Location& where);

/// Sets the keys of one layer: its guiding.preset first, whichever place it stands at, then the others in their order.
/// The layers of a job, each over the one before: defaults, the scene's integrator and sampler, the job file, --set.
void apply_layer(Job& job, std::span<const Setting> layer);

/// A scene's settings for jobs with these layers above it. Its integrator may stand for a preset (`guided_path`:
/// paper); where a layer chooses guiding.type, a preset or an estimator that nothing guides, guiding is the job's, and
/// the scene's preset does not hold.
/// Where one has a budget, the scene's seconds do not hold.
std::vector<Setting> scene_layer(std::span<const Setting> scene, std::initializer_list<std::span<const Setting>> above);

/// The text of a TOML file that a person names; `kind` is "job" or "schedule", for messages. Throws InputError.
std::string read_settings_text(const std::filesystem::path& path, const std::string& kind);

/// The settings of a job file, types checked, values not yet applied. scene.file comes back as an absolute path: it is
/// relative to the job file's folder. Throws InputError with file:line:column.
std::vector<Setting> read_job_settings(const std::filesystem::path& path);

/// The settings in TOML text; `name` stands for the file in messages. Paths are left as they are. What stands
/// below [policy] and [experiment] comes back as settings "policy..." and "experiment...", which are no keys of a job
/// (plan/resolve/resolved_file.h).
std::vector<Setting> parse_job_settings(const std::string& toml, const std::string& name);

/// A setting from the text of --set: "key=value". Quotes around the value are optional.
Setting parse_set_argument(const std::string& argument);

/// Defaults and the job file alone.
Job read_job_file(const std::filesystem::path& path);

/// TOML text with every key, that reads back to the same job.
std::string write_job(const Job& job);

}  // namespace treefarm
