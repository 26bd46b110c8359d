// SPDX-License-Identifier: Apache-2.0
#include "common/film/aov.h"

#include <algorithm>
#include <cstring>

namespace treefarm {

namespace {

constexpr AovKind kKinds[] = {
    {Aov::albedo, "albedo", "RGB", false,
     "fraction of white light that the first surface reflects which is no mirror and no smooth glass"},
    {Aov::normal, "normal", "XYZ", false, "shading normal there, in world space, towards where the ray came from"},
    {Aov::geometric_normal, "geometric_normal", "XYZ", false, "geometric normal of the first surface, as above"},
    {Aov::depth, "depth", "Z", true,
     "distance of the first surface along the camera's axis (panoramas: along the ray), in scene units"},
    {Aov::distance, "distance", "Z", true, "distance of the first surface along the ray, in scene units"},
    {Aov::position, "position", "XYZ", true, "point of the first surface, in world space"},
    {Aov::uv, "uv", "UV", true, "texture coordinates there"},
    {Aov::shape, "shape", "I", true, "number of the first surface's shape, from 1 on; 0: none"},
    {Aov::material, "material", "I", true, "number of the first surface's material, from 1 on; 0: none"},
    {Aov::alpha, "alpha", "A", false, "fraction of the samples that meet a surface"},
    {Aov::direct, "direct", "RGB", false, "light by paths of at most two edges: emitters seen, and what they light"},
    {Aov::indirect, "indirect", "RGB", false, "the image without that light"},
    {Aov::spp, "spp", "Y", true, "samples that the pixel's colour is made of"},
};

}  // namespace

std::span<const AovKind> aov_kinds() {
    return kKinds;
}

const AovKind& kind_of(Aov aov) {
    return kKinds[static_cast<std::size_t>(aov)];
}

const AovKind* find_aov(const std::string& name) {
    const auto at =
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](const AovKind& k) { return k.name == name; });
    return at == std::end(kKinds) ? nullptr : at;
}

std::vector<std::string> AovRequest::channels() const {
    const AovKind& kind = kind_of(aov);
    if (aov == Aov::alpha && layer == kind.name) return {"A"};
    std::vector<std::string> names;
    for (const char* component = kind.components; *component != 0; ++component)
        names.push_back(layer + "." + *component);
    return names;
}

AovLayout::AovLayout(std::span<const AovRequest> requests) : AovLayout() {
    const auto wanted = [&](Aov aov) {
        return std::any_of(requests.begin(), requests.end(), [&](const AovRequest& r) { return r.aov == aov; });
    };
    const auto append = [&](Aov aov) {
        at_[static_cast<std::size_t>(aov)] = size_;
        size_ += static_cast<std::uint32_t>(std::strlen(kind_of(aov).components));
    };
    if (wanted(Aov::alpha) || wanted(Aov::depth) || wanted(Aov::distance) || wanted(Aov::position) || wanted(Aov::uv))
        append(Aov::alpha);
    for (const Aov aov :
         {Aov::albedo, Aov::normal, Aov::geometric_normal, Aov::depth, Aov::distance, Aov::position, Aov::uv})
        if (wanted(aov)) append(aov);
    id_begin_ = size_;
    for (const Aov aov : {Aov::shape, Aov::material})
        if (wanted(aov)) append(aov);
    direct_ = wanted(Aov::direct) || wanted(Aov::indirect);
}

}  // namespace treefarm
