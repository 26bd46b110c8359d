// SPDX-License-Identifier: Apache-2.0
#include "common/config/toml_kind.h"

#include <initializer_list>
#include <string_view>

#include "common/base/text/parse_text.h"
#include "common/config/toml_settings.h"

namespace treefarm {

namespace {

/// First of these keys that a table has, or nullptr.
const toml::key* first_key(const toml::table& table, std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys)
        if (const auto found = table.find(key); found != table.cend()) return &found->first;
    return nullptr;
}

/// A key that only studies have, such as [scene.NAME]; or nullptr.
const toml::key* study_key(const toml::table& table) {
    if (const toml::key* key = first_key(table, {"method", "vary", "seeds", "baseline", "warmup"})) return key;
    if (const toml::table* scenes = table["scene"].as_table())
        for (const auto& [name, node] : *scenes)
            if (name.str() != "defines" && node.is_table() && node.as_table()->contains("file")) return &name;
    return nullptr;
}

/// A key that only jobs have, or nullptr.
const toml::key* job_key(const toml::table& table) {
    if (const toml::key* key =
            first_key(table, {"integrator", "image", "guiding", "sampler", "farm", "output", "effects"}))
        return key;
    const toml::table* scene = table["scene"].as_table();
    if (scene != nullptr && (*scene)["file"].is_string()) return first_key(*scene, {"file"});
    return nullptr;
}

[[noreturn]] void refuse(const toml::key& key, const std::string& file, const std::string& what,
                         const std::string& cure) {
    throw InputError(toml_location(key.source(), file), in_quotes(key.str()) + " is a key of " + what, cure);
}

}  // namespace

void require_kind(const toml::table& table, const std::string& file, TomlKind wanted) {
    const toml::key* const study = study_key(table);
    if (const toml::key* pass = first_key(table, {"pass"}); pass != nullptr && table["pass"].is_array())
        refuse(*pass, file, "schedules", "write treefarm render job.toml --schedule " + shell_quoted(file));
    if (wanted == TomlKind::job && study != nullptr)
        refuse(*study, file, "studies, and this command takes a job", "write treefarm study " + file);
    if (wanted == TomlKind::study && study == nullptr)
        if (const toml::key* job = job_key(table))
            refuse(*job, file, "jobs, and treefarm study takes a study", "write treefarm render " + shell_quoted(file));
}

}  // namespace treefarm
