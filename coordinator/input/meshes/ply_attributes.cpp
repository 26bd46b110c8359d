// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/ply_attributes.h"

#include <array>
#include <string_view>

namespace treefarm::ply {
namespace {

/// Suffixes of properties that belong together, in order.
constexpr std::string_view kSchemes[] = {"xyzw", "rgba", "0123", "1234"};

std::size_t index_of(const Element& element, std::string_view name) {
    for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (element.properties[i].name == name && !element.properties[i].is_list) return i;
    return element.properties.size();
}

/// Number of properties from `first` on that follow a scheme.
std::size_t length_of_run(const Element& element, std::size_t first, std::string_view scheme) {
    const std::string& name = element.properties[first].name;
    const std::string stem = name.substr(0, name.size() - 1);
    std::size_t length = 0;
    for (std::size_t i = first; i < element.properties.size() && length < scheme.size(); ++i, ++length)
        if (element.properties[i].is_list || element.properties[i].name != stem + scheme[length]) break;
    return length;
}

}  // namespace

std::vector<AttributeGroup> attribute_groups(const Element& element) {
    const std::string prefix = element.name + "_";
    std::vector<AttributeGroup> groups;
    for (const auto& names : {std::array{"r", "g", "b"}, std::array{"red", "green", "blue"}}) {
        AttributeGroup color{prefix + "color", {}};
        for (const char* name : names)
            if (const std::size_t i = index_of(element, name); i < element.properties.size())
                color.properties.push_back(i);
        if (color.properties.size() == 3 && groups.empty()) groups.push_back(color);
    }
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const std::string& name = element.properties[i].name;
        if (name.size() < 3 || name[name.size() - 2] != '_') continue;
        for (const std::string_view scheme : kSchemes) {
            const std::size_t length = length_of_run(element, i, scheme);
            if (length == 0) continue;
            const bool has_alpha = scheme == "rgba" && length == 4;
            if (length != 1 && length != 3 && !has_alpha) continue;
            AttributeGroup group{prefix + name.substr(0, name.size() - 2), {i}};
            if (length > 1) group.properties = {i, i + 1, i + 2};
            groups.push_back(group);
            if (scheme == "rgba") groups.push_back({group.name + "_color", group.properties});
            i += length - 1;
            break;
        }
    }
    return groups;
}

}  // namespace treefarm::ply
