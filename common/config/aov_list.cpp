// SPDX-License-Identifier: Apache-2.0
#include "common/config/aov_list.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "common/base/text/parse_text.h"

namespace treefarm {

namespace {

/// Whether the image file has this layer without a request.
bool is_taken(const std::string& layer) {
    return layer == "variance" || layer == "halfA" || layer == "halfB";
}

bool is_layer_name(const std::string& name) {
    constexpr std::size_t kLongest = 200;
    const auto allowed = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
    };
    return !name.empty() && name.size() <= kLongest && std::all_of(name.begin(), name.end(), allowed) &&
           name.front() != '.' && name.back() != '.';
}

/// The request in one entry of the list; `why` is set if the entry is malformed.
AovRequest parse_entry(const std::string& entry, std::string& why) {
    const std::size_t colon = entry.rfind(':');
    const std::string name(trim(std::string_view(entry).substr(colon == std::string::npos ? 0 : colon + 1)));
    const AovKind* kind = find_aov(name);
    if (kind == nullptr) {
        std::vector<std::string> names;
        for (const AovKind& known : aov_kinds())
            names.emplace_back(known.name);
        const std::string nearest = nearest_word(name, names);
        why = "there is no AOV " + in_quotes(name) + (nearest.empty() ? "" : "; did you mean " + nearest + "?");
        return {};
    }
    AovRequest request{kind->aov, kind->name};
    if (colon != std::string::npos) {
        request.layer = trim(std::string_view(entry).substr(0, colon));
        if (!is_layer_name(request.layer))
            why = in_quotes(request.layer) + R"( is no name of a layer: give letters, digits, "_", "-" and ".")";
    }
    if (is_taken(request.layer)) why = "the image has a layer " + in_quotes(request.layer) + " in any case";
    return request;
}

}  // namespace

std::vector<AovRequest> parse_aovs(const std::string& text, std::string& why) {
    std::vector<AovRequest> requests;
    std::set<std::string> channels;
    why.clear();
    for (std::size_t begin = 0; begin <= text.size() && !trim(text).empty();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const AovRequest request = parse_entry(std::string(trim(text.substr(begin, end - begin))), why);
        if (!why.empty()) return {};
        for (const std::string& channel : request.channels())
            if (!channels.insert(channel).second) why = "the channel " + channel + " is asked for twice";
        if (!why.empty()) return {};
        requests.push_back(request);
        begin = end + 1;
    }
    return requests;
}

std::vector<AovRequest> aov_requests(const Job& job) {
    std::string why;
    return parse_aovs(job.output.aovs, why);
}

std::string aov_text(const AovRequest& request) {
    const std::string name = kind_of(request.aov).name;
    return request.layer == name ? name : request.layer + ":" + name;
}

}  // namespace treefarm
