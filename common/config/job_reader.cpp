#include "common/config/job_reader.h"

#include <toml++/toml.h>

#include <fstream>
#include <sstream>
#include <string_view>

#include "common/config/effect_switches.h"
#include "common/config/job_keys.h"
#include "common/config/parse_text.h"

namespace treefarm {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 16u << 20;

Location place(const toml::source_region& region, const std::string& file) {
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

bool is_define(const std::string& name) {
    return name.starts_with(kDefinesPrefix) && name.size() > std::string_view(kDefinesPrefix).size();
}

/// A section is the beginning of some key's name: "scene", "scene.defines".
bool is_section(const std::string& name) {
    const std::string beginning = name + ".";
    for (const JobKey& key : job_keys())
        if (key.name.starts_with(beginning)) return true;
    return beginning == kDefinesPrefix;
}

[[noreturn]] void refuse_key(const std::string& name, const Location& where) {
    for (const auto& [key, cure] : unavailable_job_keys())
        if (key == name) throw InputError(where, name + " is not available in this version", cure);
    for (const auto& [effect, cure] : effects_without_switch())
        if (name == kEffectsPrefix + effect) throw InputError(where, name + " cannot be switched off by a key", cure);
    std::vector<std::string> names;
    for (const JobKey& key : job_keys())
        names.push_back(key.name);
    const std::string nearest = nearest_word(name, names);
    throw InputError(where, "unknown key " + in_quotes(name),
                     nearest.empty() ? "see docs/jobs.md for the keys" : "did you mean " + nearest + "?");
}

const JobKey& require_key(const std::string& name, const Location& where) {
    const JobKey* key = find_job_key(name);
    if (key == nullptr) refuse_key(name, where);
    return *key;
}

void refuse_unavailable(const JobKey& key, const std::string& value, const Location& where) {
    for (const UnavailableValue& planned : key.unavailable)
        if (planned.value == value)
            throw InputError(where, key.name + " = \"" + value + "\" is not available in this version", planned.cure);
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
        case ValueKind::text:
            break;
    }
    return "text in quotes";
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
    return {};
}

void collect(const toml::table& table, const std::string& prefix, const std::string& file,
             std::vector<Setting>& settings) {
    for (const auto& [toml_key, node] : table) {
        const std::string name = prefix + std::string(toml_key.str());
        const Location key_place = place(toml_key.source(), file);
        const Location value_place = place(node.source(), file);
        if (const toml::table* section = node.as_table(); section != nullptr && !is_define(name)) {
            if (!is_section(name)) refuse_key(name, key_place);
            collect(*section, name + ".", file, settings);
            continue;
        }
        if (is_define(name)) {
            if (!node.is_value())
                throw InputError(value_place, name + " is " + toml_type_name(node), "give text or a number");
        } else {
            const JobKey& key = require_key(name, key_place);
            if (node.is_string()) refuse_unavailable(key, value_text(node), value_place);
            if (!matches(node, key.kind))
                throw InputError(value_place,
                                 name + " is " + toml_type_name(node) + ", not " + wanted_type_name(key.kind),
                                 "allowed: " + key.range);
        }
        settings.push_back({name, value_text(node), value_place});
    }
}

std::string toml_string(const std::string& text) {
    std::ostringstream out;
    out << toml::value<std::string>(text);
    return out.str();
}

std::string toml_key(const std::string& key) {
    constexpr std::string_view bare = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    return !key.empty() && key.find_first_not_of(bare) == std::string::npos ? key : toml_string(key);
}

}  // namespace

void apply_setting(Job& job, const std::string& key_name, const std::string& value, const Location& where) {
    if (is_define(key_name)) {
        job.scene.defines[key_name.substr(std::string_view(kDefinesPrefix).size())] = value;
        return;
    }
    const JobKey& key = require_key(key_name, where);
    refuse_unavailable(key, value, where);
    if (key.kind == ValueKind::off_switch && value == "true")
        throw InputError(where, key.name + " cannot be forced on: it is on wherever the scene calls for it",
                         "leave the key out; treefarm plan tells what is on and why");
    if (!key.parse(job, value))
        throw InputError(where, key.name + " = " + in_quotes(value) + " is not allowed", "allowed: " + key.range);
    if (key.name == "guiding.preset")
        for (const Setting& setting : preset_settings(value))
            apply_setting(job, setting.key, setting.value, where);
}

void apply_layer(Job& job, std::span<const Setting> layer) {
    const auto apply = [&](bool presets) {
        for (const Setting& setting : layer)
            if ((setting.key == "guiding.preset") == presets)
                apply_setting(job, setting.key, setting.value, setting.where);
    };
    apply(true);
    apply(false);
}

std::vector<Setting> parse_job_settings(const std::string& toml, const std::string& name) {
    std::vector<Setting> settings;
    try {
        const toml::table table = toml::parse(toml, std::string_view(name));
        collect(table, "", name, settings);
    } catch (const toml::parse_error& error) {
        throw InputError(place(error.source(), name), "this is not TOML: " + one_line(error.description()),
                         "write key = value, text in quotes");
    }
    return settings;
}

std::string read_settings_text(const std::filesystem::path& path, const std::string& kind) {
    const Location where{path.string()};
    const std::string cure = "give a " + kind + " file (.toml)";
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw InputError(where, "no such " + kind + " file", "check the path");
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(where, "not a file", cure);
    if (std::filesystem::file_size(path, error) > kMaxFileBytes)
        throw InputError(where, "more than 16 MiB, which no " + kind + " file has", cure);
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw InputError(where, "cannot be read", "check its permissions");
    return text.str();
}

std::vector<Setting> read_job_settings(const std::filesystem::path& path) {
    std::vector<Setting> settings = parse_job_settings(read_settings_text(path, "job"), path.string());
    for (Setting& setting : settings) {
        if (setting.key != "scene.file" || setting.value.empty()) continue;
        const std::filesystem::path file = path.parent_path() / setting.value;
        setting.value = std::filesystem::absolute(file).lexically_normal().string();
    }
    return settings;
}

Setting parse_set_argument(const std::string& argument) {
    const Location where{"--set " + argument};
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos)
        throw InputError(where, "no \"=\" in it", "write --set key=value, for instance --set budget.spp=128");
    const std::string key(trim(std::string_view(argument).substr(0, equals)));
    std::string_view value = trim(std::string_view(argument).substr(equals + 1));
    if (value.size() >= 2 && (value.front() == '"' || value.front() == '\'') && value.back() == value.front())
        value = value.substr(1, value.size() - 2);
    if (!is_define(key)) require_key(key, where);
    return {key, std::string(value), where};
}

Job read_job_file(const std::filesystem::path& path) {
    Job job;
    apply_layer(job, read_job_settings(path));
    return job;
}

std::string write_job(const Job& job) {
    std::string text;
    std::string section;
    const auto begin_section = [&](const std::string& name) {
        if (name == section) return;
        text += (text.empty() ? "[" : "\n[") + name + "]\n";
        section = name;
    };
    // A key of [scene] must not stand below [scene.defines].
    const auto write_defines = [&] {
        if (job.scene.defines.empty()) return;
        begin_section("scene.defines");
        for (const auto& [name, value] : job.scene.defines)
            text += toml_key(name) + " = " + toml_string(value) + "\n";
    };
    bool defines_written = false;
    for (const JobKey& key : job_keys()) {
        if (!key.stored()) continue;
        const std::size_t dot = key.name.find('.');
        const std::string name = key.name.substr(0, dot);
        if (name != "scene" && !defines_written) {
            write_defines();
            defines_written = true;
        }
        begin_section(name);
        std::string value = key.print(job);
        const bool word = key.kind == ValueKind::text || (key.kind == ValueKind::off_switch && value != "false") ||
                          (key.kind == ValueKind::number_or_text && !parse_number(value));
        if (word) value = toml_string(value);
        // TOML tells numbers from integers by the point; reading takes both.
        text += key.name.substr(dot + 1) + " = " + value + "\n";
    }
    return text;
}

}  // namespace treefarm
