#include "common/scene/material_traits.h"

#include <functional>
#include <set>
#include <type_traits>

namespace treefarm {
namespace {

/// Material index of the parts of a material: at most three, kNone where there is none.
struct Parts {
    std::int32_t index[3] = {kNone, kNone, kNone};
};

Parts parts_of(const Material& material) {
    Parts parts;
    if (const auto* blend = std::get_if<BlendMaterial>(&material.bsdf)) {
        parts.index[0] = blend->first;
        parts.index[1] = blend->second;
    }
    if (material.twosided) parts.index[2] = material.back;
    return parts;
}

void add_roughness(const Roughness& roughness, bool transmits, MaterialTraits& traits) {
    (roughness.smooth() ? traits.lobes.delta_reflection : traits.lobes.glossy_reflection) = true;
    if (transmits) (roughness.smooth() ? traits.lobes.delta_transmission : traits.lobes.glossy_transmission) = true;
    if (roughness.smooth()) return;
    traits.microfacets = true;
    traits.anisotropic |= !(roughness.alpha_u == roughness.alpha_v);
    traits.textured |= roughness.alpha_u.varies() || roughness.alpha_v.varies();
}

}  // namespace

MaterialTraits own_traits(const Material& material) {
    MaterialTraits traits;
    const auto of = [&](const auto& bsdf) {
        using Kind = std::decay_t<decltype(bsdf)>;
        if constexpr (std::is_same_v<Kind, DiffuseMaterial>) {
            traits.lobes.diffuse = true;
            traits.textured = bsdf.reflectance.varies();
        } else if constexpr (std::is_same_v<Kind, ConductorMaterial>) {
            add_roughness(bsdf.roughness, false, traits);
            traits.textured |= bsdf.specular_reflectance.varies();
        } else if constexpr (std::is_same_v<Kind, DielectricMaterial>) {
            add_roughness(bsdf.roughness, true, traits);
            traits.textured |= bsdf.specular_reflectance.varies() || bsdf.specular_transmittance.varies();
        } else if constexpr (std::is_same_v<Kind, ThinDielectricMaterial>) {
            traits.lobes.delta_reflection = traits.lobes.delta_transmission = true;
            traits.textured = bsdf.specular_reflectance.varies() || bsdf.specular_transmittance.varies();
        } else if constexpr (std::is_same_v<Kind, PlasticMaterial>) {
            traits.lobes.diffuse = traits.coated = true;
            add_roughness(bsdf.roughness, false, traits);
            traits.textured |= bsdf.diffuse_reflectance.varies() || bsdf.specular_reflectance.varies();
        } else if constexpr (std::is_same_v<Kind, BlendMaterial>) {
            traits.blended = true;
            traits.textured = bsdf.weight.varies();
        } else {
            static_assert(std::is_same_v<Kind, NullMaterial>);
            traits.lobes.null = true;
        }
    };
    std::visit(of, material.bsdf);
    traits.bumped = material.detail.bump != kNone;
    traits.normal_mapped = material.detail.normal_map != kNone;
    traits.masked = material.masked();
    traits.twosided = material.twosided;
    traits.own_back = material.twosided && material.back != kNone;
    return traits;
}

Lobes& Lobes::operator|=(const Lobes& other) {
    diffuse |= other.diffuse;
    glossy_reflection |= other.glossy_reflection;
    delta_reflection |= other.delta_reflection;
    glossy_transmission |= other.glossy_transmission;
    delta_transmission |= other.delta_transmission;
    null |= other.null;
    return *this;
}

MaterialTraits& MaterialTraits::operator|=(const MaterialTraits& other) {
    lobes |= other.lobes;
    textured |= other.textured;
    bumped |= other.bumped;
    normal_mapped |= other.normal_mapped;
    masked |= other.masked;
    twosided |= other.twosided;
    own_back |= other.own_back;
    microfacets |= other.microfacets;
    anisotropic |= other.anisotropic;
    blended |= other.blended;
    coated |= other.coated;
    return *this;
}

MaterialTraits material_traits(const Scene& scene, std::int32_t material) {
    MaterialTraits traits;
    // A part stands below what it is part of: taking the highest first visits each once, however they are shared.
    std::set<std::int32_t, std::greater<>> reached = {material};
    while (!reached.empty()) {
        const std::int32_t index = *reached.begin();
        reached.erase(reached.begin());
        const Material& description = scene.materials[static_cast<std::size_t>(index)];
        MaterialTraits own = own_traits(description);
        own.masked = own.masked && index == material;
        traits |= own;
        for (const std::int32_t part : parts_of(description).index)
            if (part != kNone) reached.insert(part);
    }
    return traits;
}

std::vector<bool> used_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Shape& shape : scene.shapes)
        if (shape.material != kNone) used[static_cast<std::size_t>(shape.material)] = true;
    for (std::size_t i = scene.materials.size(); i-- > 0;)
        if (used[i])
            for (const std::int32_t part : parts_of(scene.materials[i]).index)
                if (part != kNone) used[static_cast<std::size_t>(part)] = true;
    return used;
}

MaterialTraits scene_traits(const Scene& scene) {
    std::vector<bool> of_shapes(scene.materials.size(), false);
    for (const Shape& shape : scene.shapes)
        if (shape.material != kNone) of_shapes[static_cast<std::size_t>(shape.material)] = true;
    const std::vector<bool> used = used_materials(scene);
    MaterialTraits traits;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        MaterialTraits own = own_traits(scene.materials[i]);
        own.masked = own.masked && of_shapes[i];
        traits |= own;
    }
    return traits;
}

bool is_plainly_diffuse(const Scene& scene) {
    const MaterialTraits traits = scene_traits(scene);
    const Lobes nothing_but_diffuse = {.diffuse = true};
    return (traits.lobes == nothing_but_diffuse || traits.lobes == Lobes{}) && !traits.textured && !traits.bumped &&
           !traits.normal_mapped && !traits.own_back && !traits.blended;
}

}  // namespace treefarm
