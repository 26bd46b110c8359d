// SPDX-License-Identifier: Apache-2.0
#include "common/config/toml_settings.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/text/parse_text.h"
#include "common/config/effect_switches.h"

namespace treefarm {
namespace {

/// Keys that earlier versions had, and their new names.
constexpr std::pair<const char*, const char*> kRenamedKeys[] = {
    {"guiding.light_selection", "integrator.light_selection"},
};

/// Throws InputError for a key or a table's name of more than kMostDots dots. Texts in quotes are not told from keys:
/// none has so many dots before a ']' or '='.
void refuse_deep_keys(const std::string& text, const std::string& name) {
    constexpr int kMostDots = 256;
    int dots = 0, line = 1;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '#') at = std::min(text.find('\n', at), text.size()) - 1;
        if (c == '.') ++dots;
        if ((c == '=' || c == ']') && dots > kMostDots)
            throw InputError(Location{name, line, 0}, "a key of " + std::to_string(dots) + " dots",
                             "keys have a few: repair the file");
        if (c == '\n' || c == ',' || c == '=' || c == '[' || c == ']' || c == '{' || c == '#') dots = 0;
        if (c == '\n') ++line;
    }
}

/// Whether a name is a section, that is, the beginning of a key's name: "scene", "scene.defines".
bool is_section(const std::string& name) {
    const std::string beginning = name + ".";
    for (const JobKey& key : job_keys())
        if (key.name.starts_with(beginning)) return true;
    return beginning == kDefinesPrefix;
}

std::string last_part(const std::string& name) {
    return name.substr(name.find_last_of('.') + 1);
}

/// Keys, or a section, that a misspelled name may mean: "guiding.type or integrator.type"; "" if none is near. A name
/// without its section, as "spp", means every key that ends so.
std::string likely_key(const std::string& name) {
    std::vector<std::string> names, ends;
    std::vector<std::string_view> same_end;
    for (const JobKey& key : job_keys()) {
        names.push_back(key.name);
        ends.push_back(last_part(key.name));
        if (ends.back() == last_part(name)) same_end.push_back(key.name);
        const std::string section = key.name.substr(0, key.name.find('.'));
        if (std::find(names.begin(), names.end(), section) == names.end()) names.push_back(section);
    }
    if (!same_end.empty()) return listed(same_end);
    if (const std::string nearest = nearest_word(name, names); !nearest.empty()) return nearest;
    const std::string end = nearest_word(last_part(name), ends);
    return end.empty() ? "" : likely_key(end);
}

[[noreturn]] void refuse_key(const std::string& name, const Location& where) {
    for (const auto& [effect, cure] : effects_without_switch())
        if (name == kEffectsPrefix + effect) throw InputError(where, name + " cannot be switched off by a key", cure);
    for (const auto& [old_name, new_name] : kRenamedKeys)
        if (name == old_name) throw InputError(where, in_quotes(name) + " is called " + new_name + " now", "set that");
    if (is_section(name))
        throw InputError(where, in_quotes(name) + " is no key, but a table of keys",
                         "write [" + name + "] and keys below it");
    const std::string guess = likely_key(name);
    throw InputError(where, "unknown key " + in_quotes(name),
                     guess.empty() ? "treefarm keys lists the keys" : "did you mean " + guess + "?");
}

std::string wanted_type_name(ValueKind kind) {
    switch (kind) {
        case ValueKind::integer:
            return "an integer";
        case ValueKind::number:
            return "a number";
        case ValueKind::number_or_text:
            return "a number or text in quotes";
        case ValueKind::boolean:
            return "true or false";
        case ValueKind::off_switch:
            return "false";
        case ValueKind::text_list:
            return "a list of texts in quotes";
        case ValueKind::text:
            break;
    }
    return "text in quotes";
}

bool is_text_list(const toml::node& node) {
    const toml::array* list = node.as_array();
    return list != nullptr &&
           std::all_of(list->begin(), list->end(), [](const toml::node& entry) { return entry.is_string(); });
}

bool matches(const toml::node& node, ValueKind kind) {
    switch (kind) {
        case ValueKind::integer:
            return node.is_integer();
        case ValueKind::number:
            return node.is_number();
        case ValueKind::number_or_text:
            return node.is_number() || node.is_string();
        case ValueKind::boolean:
            return node.is_boolean();
        case ValueKind::off_switch:
            return node.is_boolean() || node.is_string();
        case ValueKind::text_list:
            return node.is_string() || is_text_list(node);
        case ValueKind::text:
            break;
    }
    return node.is_string();
}

std::string value_text(const toml::node& node) {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
    if (const auto* number = node.as_floating_point()) return number_text(number->get());
    if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
    if (const auto* list = node.as_array()) {
        std::string text;
        for (const toml::node& entry : *list)
            text += (text.empty() ? "" : ",") + value_text(entry);
        return text;
    }
    return {};
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& name) {
    refuse_deep_keys(text, name);
    return toml::parse(text, std::string_view(name));
}

Location toml_location(const toml::source_region& region, const std::string& file) {
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string toml_type_name(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::string:
            return "text";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::table:
            return "a table";
        default:
            return "a date or time";
    }
}

bool is_define(const std::string& name) {
    return name.starts_with(kDefinesPrefix) && name.size() > std::string_view(kDefinesPrefix).size();
}

const JobKey& require_job_key(const std::string& name, const Location& where) {
    const JobKey* key = find_job_key(name);
    if (key == nullptr) refuse_key(name, where);
    return *key;
}

void refuse_unavailable(const JobKey& key, const std::string& value, const Location& where) {
    for (const UnavailableValue& planned : key.unavailable)
        if (planned.value == value)
            throw InputError(where, key.name + " = \"" + value + "\" is not available in this version", planned.cure);
}

Setting read_setting(const std::string& name, const Location& key_location, const toml::node& node,
                     const std::string& file) {
    const Location value_location = toml_location(node.source(), file);
    if (is_define(name)) {
        if (!node.is_value())
            throw InputError(value_location, name + " is " + toml_type_name(node), "give text or a number");
    } else {
        const JobKey& key = require_job_key(name, key_location);
        if (node.is_string()) refuse_unavailable(key, value_text(node), value_location);
        if (!matches(node, key.kind))
            throw InputError(value_location,
                             name + " is " + toml_type_name(node) + ", not " + wanted_type_name(key.kind),
                             "allowed: " + key.range);
    }
    return {name, value_text(node), value_location};
}

void for_each_job_key(const toml::table& table, const std::string& file, const TakeJobKey& take,
                      const std::string& prefix) {
    for (const auto& [toml_key, node] : table) {
        const std::string name = prefix + std::string(toml_key.str());
        const Location key_location = toml_location(toml_key.source(), file);
        if (const toml::table* section = node.as_table(); section != nullptr && !is_define(name)) {
            if (!is_section(name)) refuse_key(name, key_location);
            for_each_job_key(*section, file, take, name + ".");
        } else {
            take(name, key_location, node);
        }
    }
}

std::vector<Setting> read_settings(const toml::table& table, const std::string& file) {
    std::vector<Setting> settings;
    for_each_job_key(table, file, [&](const std::string& key, const Location& key_location, const toml::node& value) {
        settings.push_back(read_setting(key, key_location, value, file));
    });
    return settings;
}

}  // namespace treefarm
