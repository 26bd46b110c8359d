#pragma once

#include <cstdint>
#include <type_traits>

#include "common/scene/scene.h"

namespace treefarm {

/// Calls f(input) for each ColorInput and FloatInput that the BSDF of a material holds: what scatters, neither opacity
/// nor normals. `MaterialRef` is Material& or const Material&.
template <class MaterialRef, class F>
void for_each_input(MaterialRef& material, F&& f) {
    const auto of_roughness = [&](auto& roughness) {
        f(roughness.alpha_u);
        f(roughness.alpha_v);
    };
    const auto of = [&](auto& bsdf) {
        using Kind = std::decay_t<decltype(bsdf)>;
        if constexpr (std::is_same_v<Kind, DiffuseMaterial>) f(bsdf.reflectance);
        if constexpr (std::is_same_v<Kind, ConductorMaterial> || std::is_same_v<Kind, DielectricMaterial> ||
                      std::is_same_v<Kind, ThinDielectricMaterial> || std::is_same_v<Kind, PlasticMaterial>)
            f(bsdf.specular_reflectance);
        if constexpr (std::is_same_v<Kind, DielectricMaterial> || std::is_same_v<Kind, ThinDielectricMaterial>)
            f(bsdf.specular_transmittance);
        if constexpr (std::is_same_v<Kind, PlasticMaterial>) f(bsdf.diffuse_reflectance);
        if constexpr (std::is_same_v<Kind, ConductorMaterial> || std::is_same_v<Kind, DielectricMaterial> ||
                      std::is_same_v<Kind, PlasticMaterial>)
            of_roughness(bsdf.roughness);
        if constexpr (std::is_same_v<Kind, BlendMaterial>) f(bsdf.weight);
    };
    std::visit(of, material.bsdf);
}

/// Calls f(texture index) for each texture that a material names, by a reference that may be changed.
template <class MaterialRef, class F>
void for_each_texture(MaterialRef& material, F&& f) {
    const auto visit = [&](auto& index) {
        if (index != kNone) f(index);
    };
    for_each_input(material, [&](auto& input) { visit(input.texture); });
    visit(material.opacity.texture);
    visit(material.detail.bump);
    visit(material.detail.normal_map);
}

}  // namespace treefarm
