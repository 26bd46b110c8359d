// SPDX-License-Identifier: Apache-2.0
#include "common/config/techniques.h"

#include <algorithm>
#include <sstream>

#include "common/base/text/parse_text.h"

namespace treefarm {
namespace {

/// Greatest number of vertices of a subpath in a list.
constexpr std::int64_t kMostVertices = 1000;

}  // namespace

std::vector<Technique> parse_techniques(const std::string& text, std::string& why) {
    why.clear();
    if (trim(text) == "all") return {};
    std::vector<Technique> techniques;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const std::size_t comma = word.find(',');
        const auto light = parse_integer(word.substr(0, comma));
        const auto camera = comma == std::string::npos ? std::nullopt : parse_integer(word.substr(comma + 1));
        if (!light || !camera || *light < 0 || *camera < 1 || *light + *camera < 2 || *light > kMostVertices ||
            *camera > kMostVertices || (*light == 1 && *camera == 1)) {
            why = in_quotes(word) +
                  " is no technique: write how many vertices are drawn from the lamp and how many, at least one, from "
                  "the camera, for instance 1,2; a lamp that is seen directly is 0,2";
            return {};
        }
        const Technique technique{static_cast<int>(*light), static_cast<int>(*camera)};
        if (std::find(techniques.begin(), techniques.end(), technique) == techniques.end())
            techniques.push_back(technique);
    }
    if (techniques.empty()) why = "there is no technique: write all, or for instance 0,3 1,2";
    return techniques;
}

std::string techniques_text(const std::vector<Technique>& techniques) {
    std::string text;
    for (const auto& [light, camera] : techniques)
        text += (text.empty() ? "" : " ") + std::to_string(light) + "," + std::to_string(camera);
    return text.empty() ? "all" : text;
}

TechniqueSet::TechniqueSet(const std::string& text) {
    std::string why;
    listed_ = parse_techniques(text, why);
}

bool TechniqueSet::has(int light, int camera) const {
    return listed_.empty() || std::find(listed_.begin(), listed_.end(), Technique{light, camera}) != listed_.end();
}

}  // namespace treefarm
