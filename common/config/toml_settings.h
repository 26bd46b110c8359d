// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>
#include <vector>

#include "common/config/job_keys.h"
#include "common/config/setting.h"

namespace treefarm {

// Reading of job keys from TOML, shared by job and study files.

/// The table of a TOML text; `name`: its file. Throws toml::parse_error, and InputError for keys of so many dots that
/// their tables, each in the one before, would exhaust the stack.
toml::table parse_toml(const std::string& text, const std::string& name);

Location toml_location(const toml::source_region& region, const std::string& file);

/// Name of a TOML type for messages: "text", "an integer", "a table"...
std::string toml_type_name(const toml::node& node);

/// Whether the key is a value for $name in the scene: "scene.defines.name".
bool is_define(const std::string& key);

/// The key of this name. Throws InputError with the nearest name if there is none.
const JobKey& require_job_key(const std::string& name, const Location& where);

/// Throws InputError if this value is planned for a later version.
void refuse_unavailable(const JobKey& key, const std::string& value, const Location& where);

/// A job key with its value; the type is checked. Throws InputError.
Setting read_setting(const std::string& key, const Location& key_location, const toml::node& value,
                     const std::string& file);

/// All job keys of a table and its sections. Throws InputError.
std::vector<Setting> read_settings(const toml::table& table, const std::string& file);

/// Visitor of job keys: called for each with its full name.
using TakeJobKey = std::function<void(const std::string& key, const Location& key_location, const toml::node& value)>;
void for_each_job_key(const toml::table& table, const std::string& file, const TakeJobKey& take,
                      const std::string& prefix = "");

}  // namespace treefarm
