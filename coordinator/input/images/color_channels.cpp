// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/color_channels.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "common/base/error.h"

namespace treefarm {
namespace {

/// Channels of a layer by component.
using Layer = std::map<char, std::string>;

/// Component of a channel: 'R' for "R", "layer.r" and "layer.red", and so on; 0 for other channels.
char meaning_of(std::string_view component) {
    constexpr std::array<std::pair<std::string_view, char>, 8> kNames = {
        {{"r", 'R'}, {"g", 'G'}, {"b", 'B'}, {"a", 'A'}, {"y", 'Y'}, {"red", 'R'}, {"green", 'G'}, {"blue", 'B'}}};
    std::string name(component);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>('A' <= c && c <= 'Z' ? c - 'A' + 'a' : c); });
    for (const auto& [known, meaning] : kNames)
        if (name == known) return meaning;
    return 0;
}

bool has(const Layer& layer, std::string_view meanings) {
    return std::all_of(meanings.begin(), meanings.end(), [&](char m) { return layer.contains(m); });
}

std::vector<std::string> channels_of(const Layer& layer, std::string_view meanings) {
    std::vector<std::string> names;
    for (const char meaning : meanings)
        names.push_back(layer.at(meaning));
    if (const auto alpha = layer.find('A'); alpha != layer.end()) names.push_back(alpha->second);
    return names;
}

}  // namespace

std::vector<std::string> choose_color_channels(const std::filesystem::path& path,
                                               const std::vector<std::string>& names) {
    std::map<std::string, Layer> layers;
    std::string all;
    for (const std::string& name : names) {
        const std::size_t dot = name.rfind('.');
        const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
        if (const char meaning = meaning_of(std::string_view(name).substr(dot == std::string::npos ? 0 : dot + 1)))
            layers[layer].emplace(meaning, name);
        all += (all.empty() ? "" : ", ") + name;
    }
    for (const char* const meanings : {"RGB", "Y"}) {
        if (const auto top = layers.find(""); top != layers.end() && has(top->second, meanings))
            return channels_of(top->second, meanings);
    }
    for (const char* const meanings : {"RGB", "Y"}) {
        std::vector<std::string> found;
        std::string list;
        for (const auto& [name, layer] : layers) {
            if (!has(layer, meanings)) continue;
            found.push_back(name);
            list += (list.empty() ? "" : ", ") + name;
        }
        if (found.size() > 1)
            throw InputError(Location{path.string()}, "has colours in several layers: " + list,
                             "save the one that is meant as R, G, B");
        if (found.size() == 1) return channels_of(layers.at(found[0]), meanings);
    }
    throw InputError(Location{path.string()}, "has neither the channels R, G, B nor Y in any layer, but " + all,
                     "save the picture as R, G, B");
}

}  // namespace treefarm
