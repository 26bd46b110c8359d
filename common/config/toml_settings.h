// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>
#include <vector>

#include "common/config/job_keys.h"
#include "common/config/setting.h"

namespace treefarm {

// What job and study files share: job keys as TOML holds them.

Location toml_location(const toml::source_region& region, const std::string& file);

/// "text", "an integer", "a table"...: for messages.
std::string toml_type_name(const toml::node& node);

/// Whether this is a value for $name in the scene: "scene.defines.name".
bool is_define(const std::string& key);

/// The key of this name; throws InputError with the nearest one where there is none.
const JobKey& require_job_key(const std::string& name, const Location& where);

/// Throws InputError where the key has this value in a later version only.
void refuse_unavailable(const JobKey& key, const std::string& value, const Location& where);

/// One job key with a value whose type fits. Throws InputError.
Setting read_setting(const std::string& key, const Location& key_location, const toml::node& value,
                     const std::string& file);

/// All job keys of a table, sections within it included. Throws InputError.
std::vector<Setting> read_settings(const toml::table& table, const std::string& file);

/// Goes through a table of job keys: sections are entered, everything else is handed over with its whole name.
using TakeJobKey = std::function<void(const std::string& key, const Location& key_location, const toml::node& value)>;
void for_each_job_key(const toml::table& table, const std::string& file, const TakeJobKey& take,
                      const std::string& prefix = "");

}  // namespace treefarm
