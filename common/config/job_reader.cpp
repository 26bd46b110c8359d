// SPDX-License-Identifier: Apache-2.0
#include "common/config/job_reader.h"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>

#include "common/base/text/parse_text.h"
#include "common/config/estimators.h"
#include "common/config/job_keys.h"
#include "common/config/presets.h"
#include "common/config/toml_kind.h"
#include "common/config/toml_settings.h"

namespace treefarm {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 16u << 20;

std::string toml_string(const std::string& text) {
    // In a multi-line string toml++ loses a leading newline, and keys cannot be multi-line; so newlines are escaped.
    const bool one_line = text.find('\n') == std::string::npos;
    const toml::format_flags escaped =
        toml::toml_formatter::default_flags &
        ~(toml::format_flags::allow_multi_line_strings | toml::format_flags::allow_literal_strings);
    const toml::value<std::string> value(text);
    std::ostringstream out;
    out << toml::toml_formatter(value, one_line ? toml::toml_formatter::default_flags : escaped);
    return out.str();
}

/// A comma-separated text as a TOML list.
std::string toml_list(const std::string& text) {
    std::string list;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        list += (list.empty() ? "" : ", ") + toml_string(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return "[" + list + "]";
}

std::string toml_key(const std::string& key) {
    constexpr std::string_view bare = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    return !key.empty() && key.find_first_not_of(bare) == std::string::npos ? key : toml_string(key);
}

/// Reads a section that only resolved.toml has, whose names this module does not know (plan/resolve/resolved_file.h
/// checks them).
void read_record(const toml::table& section, const std::string& prefix, const std::string& file,
                 std::vector<Setting>& settings) {
    for (const auto& [key, node] : section) {
        const std::string name = prefix + std::string(key.str());
        const Location where = toml_location(node.source(), file);
        if (const toml::table* part = node.as_table())
            read_record(*part, name + ".", file, settings);
        else if (const auto text = node.value<std::string>(); text)
            settings.push_back({name, *text, where});
        else if (const auto value = node.value<double>())
            settings.push_back({name, number_text(*value), where});
        else
            throw InputError(where, name + " is neither number nor text", "write what the render wrote");
    }
}

}  // namespace

void apply_setting(Job& job, const std::string& key_name, const std::string& value, const Location& where) {
    if (is_define(key_name)) {
        job.scene.defines[key_name.substr(std::string_view(kDefinesPrefix).size())] = value;
        return;
    }
    const JobKey& key = require_job_key(key_name, where);
    refuse_unavailable(key, value, where);
    if (key.kind == ValueKind::off_switch && value == "true")
        throw InputError(where, key.name + " cannot be forced on: it is on wherever the scene calls for it",
                         "leave the key out; treefarm plan tells what is on and why");
    if (!key.parse(job, value)) {
        const std::string reason = key.refusal ? ": " + key.refusal(value) : " is not allowed";
        throw InputError(where, key.name + " = " + in_quotes(value) + reason, "allowed: " + key.range);
    }
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

std::vector<Setting> scene_layer(std::span<const Setting> scene,
                                 std::initializer_list<std::span<const Setting>> above) {
    const auto chosen = [&](std::initializer_list<std::string_view> keys) {
        return std::any_of(above.begin(), above.end(), [&](std::span<const Setting> layer) {
            return std::any_of(layer.begin(), layer.end(), [&](const Setting& s) {
                return std::find(keys.begin(), keys.end(), s.key) != keys.end();
            });
        });
    };
    std::vector<Setting> layer(scene.begin(), scene.end());
    const auto drop = [&](std::string_view key) {
        std::erase_if(layer, [&](const Setting& s) { return s.key == key; });
    };
    const bool unguided = std::any_of(above.begin(), above.end(), [](std::span<const Setting> settings) {
        return std::any_of(settings.begin(), settings.end(), [](const Setting& s) {
            const Estimator* estimator = s.key == "integrator.type" ? find_estimator(s.value) : nullptr;
            return estimator && !estimator->guides;
        });
    });
    if (unguided || chosen({"guiding.type", "guiding.preset"})) drop("guiding.preset");
    // A time limit of the scene would override samples that the job asks for.
    if (chosen({"budget.spp", "budget.seconds", "budget.error"})) drop("budget.seconds");
    return layer;
}

std::vector<Setting> parse_job_settings(const std::string& toml, const std::string& name) {
    std::vector<Setting> settings;
    try {
        toml::table table = parse_toml(toml, name);
        require_kind(table, name, TomlKind::job);
        std::vector<Setting> record;
        for (const std::string section : {"experiment", "policy"}) {
            const toml::table* part = table[section].as_table();
            if (part == nullptr) continue;
            read_record(*part, section + ".", name, record);
            table.erase(section);
        }
        settings = read_settings(table, name);
        settings.insert(settings.end(), record.begin(), record.end());
    } catch (const toml::parse_error& error) {
        throw InputError(toml_location(error.source(), name), "this is not TOML: " + one_line(error.description()),
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
        if ((setting.key != "scene.file" && setting.key != "scene.root") || setting.value.empty()) continue;
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
    if (!is_define(key)) require_job_key(key, where);
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
    // Keys of [scene] must come before [scene.defines].
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
        if (key.kind == ValueKind::text_list) value = toml_list(value);
        // TOML tells numbers from integers by the point; the reader takes both.
        text += key.name.substr(dot + 1) + " = " + value + "\n";
    }
    return text;
}

}  // namespace treefarm
