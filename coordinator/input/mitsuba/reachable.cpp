// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "coordinator/input/mitsuba/properties.h"
#include "coordinator/input/mitsuba/scene_document.h"

namespace treefarm::mitsuba {
namespace {

void visit(const XmlElement& element, const SceneDocument& document, std::set<const XmlElement*>& found) {
    if (!found.insert(&element).second) return;
    for (const XmlElement& child : element.children)
        if (child.tag == "ref" || is_object_tag(child.tag)) visit(document.resolve(child), document, found);
}

}  // namespace

bool is_definition(const XmlElement& element) {
    constexpr std::array<std::string_view, 9> kTags = {"bsdf",       "texture", "sampler", "film",  "rfilter",
                                                       "subsurface", "medium",  "phase",   "volume"};
    if (element.tag == "shape") {
        const std::string* type = element.find("type");
        return type != nullptr && lower_case(*type) == "shapegroup";
    }
    return std::find(kTags.begin(), kTags.end(), element.tag) != kTags.end();
}

std::set<const XmlElement*> reachable_objects(const SceneDocument& document) {
    std::set<const XmlElement*> found;
    for (const XmlElement& child : document.root().children) {
        if (child.tag != "ref" && !is_object_tag(child.tag)) continue;
        const XmlElement& object = document.resolve(child);
        if (!is_definition(object)) visit(object, document, found);
    }
    return found;
}

}  // namespace treefarm::mitsuba
