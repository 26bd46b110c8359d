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

/// Sets one key. guiding.preset sets all keys of the preset. Throws InputError at the setting's location for an unknown
/// key, a value of wrong range or type, and a value not available in this version.
void apply_setting(Job& job, const std::string& key, const std::string& value, const Location& where);

/// Sets the keys of one layer: its guiding.preset first, wherever it stands, then the others in order. A job has these
/// layers, later ones override: defaults, the scene's integrator and sampler, the job file, --set.
void apply_layer(Job& job, std::span<const Setting> layer);

/// The scene's settings that apply below the given layers of a job. A scene's integrator may imply a preset
/// (`guided_path`: paper), which is dropped if a layer sets guiding.type, a preset or an estimator without guiding. The
/// scene's time limit is dropped if a layer has a budget.
std::vector<Setting> scene_layer(std::span<const Setting> scene, std::initializer_list<std::span<const Setting>> above);

/// Text of a TOML file given by a user; `kind` is "job" or "schedule", for messages. Throws InputError.
std::string read_settings_text(const std::filesystem::path& path, const std::string& kind);

/// Settings of a job file, with types checked, not yet applied. scene.file becomes absolute; in the file it is relative
/// to the job file's folder. Throws InputError with file:line:column.
std::vector<Setting> read_job_settings(const std::filesystem::path& path);

/// Settings of a TOML text; `name` stands for the file in messages. Paths stay as they are. Entries below [policy] and
/// [experiment] become settings "policy..." and "experiment...", which are not job keys (plan/resolve/resolved_file.h).
std::vector<Setting> parse_job_settings(const std::string& toml, const std::string& name);

/// Setting from the argument "key=value" of --set. Quotes around the value are optional.
Setting parse_set_argument(const std::string& argument);

/// Job from the defaults and a job file.
Job read_job_file(const std::filesystem::path& path);

/// TOML text with all keys, which reads back to the same job.
std::string write_job(const Job& job);

}  // namespace treefarm
