// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/substitution.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "common/base/text/parse_text.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::size_t kMaxAttributeBytes = std::size_t{1} << 24;
constexpr std::size_t kMaxReplacedBytes = std::size_t{1} << 26;

/// Cure for an unused name: a similar name of the scene, or another guess.
std::string cure_of_unused(const std::string& name, const std::string& value, const std::vector<std::string>& used) {
    if ((name == "width" || name == "height") && std::find(used.begin(), used.end(), name) == used.end())
        return "the image's " + name + " is --set image." + name + "=" + value;
    const std::string nearest = nearest_word(name, used);
    if (!nearest.empty()) return "did you mean $" + nearest + "?";
    std::string known;
    for (const std::string& other : used)
        known += (known.empty() ? "$" : ", $") + other;
    return used.empty() ? "remove it: the scene has no $names" : "remove it, or choose from " + known;
}

}  // namespace

Parameters::Parameters(const std::map<std::string, std::string>& defines) {
    for (const auto& [name, value] : defines)
        parameters_[name] = {value, false};
}

void Parameters::add_default(const std::string& name, const std::string& value, const Location& where) {
    if (name.empty()) throw InputError(where, "<default> has an empty name", "give it a name");
    const auto [entry, is_new] = parameters_.emplace(name, Parameter{value, true});
    entry->second.used = true;
}

std::string Parameters::substitute(const std::string& text, const Location& where) {
    if (text.find('$') == std::string::npos) return text;
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] != '$') {
            result += text[at++];
            continue;
        }
        const std::string_view rest = std::string_view(text).substr(at + 1);
        auto best = parameters_.end();
        for (auto it = parameters_.begin(); it != parameters_.end(); ++it)
            if (rest.starts_with(it->first) && (best == parameters_.end() || it->first.size() > best->first.size()))
                best = it;
        if (best == parameters_.end())
            throw InputError(where, in_quotes(text) + " uses a $name that has no value",
                             "give one with -D name=value, or with <default> before this place");
        best->second.used = true;
        result += best->second.value;
        at += 1 + best->first.size();
        if (result.size() > kMaxAttributeBytes)
            throw InputError(where, "an attribute has more than 16 MiB once its $names are replaced", "shorten it");
    }
    replaced_bytes_ += result.size();
    if (replaced_bytes_ > kMaxReplacedBytes)
        throw InputError(where, "the attributes have more than 64 MiB once their $names are replaced", "shorten them");
    return result;
}

void Parameters::require_all_used(const Location& scene) const {
    std::vector<std::string> used;
    for (const auto& [name, parameter] : parameters_)
        if (parameter.used) used.push_back(name);
    for (const auto& [name, parameter] : parameters_) {
        if (parameter.used) continue;
        throw InputError({scene.file}, "the scene does not use $" + name + ", which was given a value",
                         cure_of_unused(name, parameters_.at(name).value, used));
    }
}

}  // namespace treefarm::mitsuba
