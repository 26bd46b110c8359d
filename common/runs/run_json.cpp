// SPDX-License-Identifier: Apache-2.0
#include "common/runs/run_json.h"

#include <utility>

#include "common/base/files/read_bytes.h"

namespace treefarm {

namespace {

/// Greatest depth of JSON: the recursive parser would need much stack for more.
constexpr int kMostDepth = 32;

RunJson member(const RunJson& object, RunKey key, bool (RunJson::*is_kind)() const noexcept) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key.name());
    return found != object.end() && ((*found).*is_kind)() ? *found : RunJson();
}

/// Whether a word is in a list separated by spaces.
bool lists(std::string_view words, std::string_view word) {
    for (std::size_t at = words.find(word); at != words.npos; at = words.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        if ((at == 0 || words[at - 1] == ' ') && (end == words.size() || words[end] == ' ')) return true;
    }
    return false;
}

/// Combines the two keys of a forecast in files of earlier studies, as in passes.csv.
void gather_forecast(RunJson& pass, const std::string& name) {
    for (const char* part : {"seconds", "trust"})
        if (const auto flat = pass.find(name + "_" + part); flat != pass.end()) {
            const RunJson value = std::move(*flat);
            pass.erase(name + "_" + part);
            if (pass[name].is_null() || pass[name].is_object()) pass[name][part] = value;
        }
}

/// File with the present names of its passes' figures.
RunJson with_current_names(RunJson file) {
    RunJson none = RunJson::array();
    const auto passes = file.find("passes");
    for (RunJson& pass : passes != file.end() && passes->is_array() ? *passes : none) {
        if (!pass.is_object()) continue;
        RunJson current = RunJson::object();
        for (auto& [name, value] : pass.items())
            current.emplace(std::string(current_name(name)), std::move(value));
        gather_forecast(current, "halving");
        gather_forecast(current, "target");
        pass = std::move(current);
    }
    return file;
}

}  // namespace

std::string_view current_name(std::string_view written) {
    for (const PassFigure& figure : kPassFigures)
        if (!written.empty() && lists(figure.former, written)) return figure.name;
    return written;
}

RunJson parse_run_json(const std::string& text) {
    const auto not_too_deep = [](int depth, RunJson::parse_event_t, RunJson&) { return depth <= kMostDepth; };
    RunJson json = RunJson::parse(text, not_too_deep, false);
    return json.is_object() ? with_current_names(std::move(json)) : RunJson::object();
}

RunJson read_run_json(const std::filesystem::path& path) {
    return parse_run_json(read_text(path));
}

RunJson read_whole_run_json(const std::filesystem::path& path) {
    return with_current_names(RunJson::parse(read_text(path)));
}

RunJson number_of(const RunJson& object, RunKey key) {
    return member(object, key, &RunJson::is_number);
}

RunJson text_of(const RunJson& object, RunKey key) {
    return member(object, key, &RunJson::is_string);
}

RunJson object_of(const RunJson& object, RunKey key) {
    return member(object, key, &RunJson::is_object);
}

RunJson array_of(const RunJson& object, RunKey key) {
    RunJson array = member(object, key, &RunJson::is_array);
    return array.is_array() ? array : RunJson::array();
}

std::string text_in(const RunJson& object, RunKey key) {
    const RunJson text = text_of(object, key);
    return text.is_string() ? text.get<std::string>() : "";
}

double number_in(const RunJson& object, RunKey key, double otherwise) {
    const RunJson number = number_of(object, key);
    return number.is_number() ? number.get<double>() : otherwise;
}

bool missed_target(const RunJson& summary) {
    const RunJson target = object_of(summary, "target");
    const auto reached = target.find("reached");
    return target.is_object() && reached != target.end() && *reached == false;
}

}  // namespace treefarm
