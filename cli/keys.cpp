// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "common/base/error.h"
#include "common/base/text/parse_text.h"
#include "common/config/job_keys.h"

namespace treefarm {

namespace {

std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// Whether a pattern is part of a key's name or meaning.
bool matches(const JobKey& key, const std::string& pattern) {
    return lower(key.name).find(pattern) != std::string::npos || lower(key.doc).find(pattern) != std::string::npos;
}

std::vector<const JobKey*> matching_keys(const std::string& pattern) {
    std::vector<const JobKey*> keys;
    std::vector<std::string> names;
    for (const JobKey& key : job_keys()) {
        names.push_back(key.name);
        if (matches(key, lower(pattern))) keys.push_back(&key);
    }
    if (!keys.empty()) return keys;
    const std::string nearest = nearest_word(pattern, names);
    throw InputError(Location{"keys", 0, 0}, "no key has " + in_quotes(pattern) + " in its name or meaning",
                     nearest.empty() ? "treefarm keys lists all of them" : "did you mean " + nearest + "?");
}

const char* type_name(ValueKind kind) {
    switch (kind) {
        case ValueKind::integer:
            return "integer";
        case ValueKind::number:
            return "number";
        case ValueKind::number_or_text:
            return "number or text";
        case ValueKind::boolean:
            return "boolean";
        case ValueKind::off_switch:
            return "false or text";
        case ValueKind::text_list:
            return "list of texts";
        case ValueKind::text:
            break;
    }
    return "text";
}

std::string default_of(const JobKey& key) {
    return key.stored() ? key.print(Job{}) : std::string();
}

void print_text(const std::vector<const JobKey*>& keys, std::ostream& out) {
    for (const JobKey* key : keys) {
        const std::string value = default_of(*key);
        out << key->name << " = " << (value.empty() ? "\"\"" : value) << "\n    " << key->doc
            << "\n    allowed: " << key->range << "\n";
    }
}

void print_json(const std::vector<const JobKey*>& keys, std::ostream& out) {
    nlohmann::ordered_json json = nlohmann::json::array();
    for (const JobKey* key : keys)
        json.push_back({{"key", key->name},
                        {"type", type_name(key->kind)},
                        {"allowed", key->range},
                        {"default", default_of(*key)},
                        {"meaning", key->doc}});
    out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

}  // namespace

void add_keys_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto pattern = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("keys", "Lists the keys of a job, with defaults and meaning");
    command->add_option("pattern", *pattern, "only keys with this in their name or meaning");
    command->add_flag("--json", *json, "print JSON instead of text");
    command->callback([pattern, json, launch, &exit_code] {
        if (launch.rank != 0) return;
        const std::vector<const JobKey*> keys = matching_keys(*pattern);
        *json ? print_json(keys, std::cout) : print_text(keys, std::cout);
        exit_code = 0;
    });
}

}  // namespace treefarm
