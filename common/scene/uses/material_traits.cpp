// SPDX-License-Identifier: Apache-2.0
#include "common/scene/uses/material_traits.h"

#include <functional>
#include <set>

#include "common/scene/uses/material_uses.h"

namespace treefarm {
namespace {

/// Traits that follow from a kind's fields.
struct FieldTraits : IgnoreFields {
    MaterialTraits& traits;
    explicit FieldTraits(MaterialTraits& to) : traits(to) {}
    void fraction(const char*, const auto& input) { traits.textured |= input.varies(); }
    void anisotropy(const FloatInput& input) {
        traits.textured |= input.varies();
        traits.anisotropic |= input.varies() || input.value > 0.0f;
    }
    void number(const char*, const auto& input, float, float) { traits.textured |= input.varies(); }
    void roughness(const Roughness& roughness, bool) {
        if (roughness.smooth()) return;
        traits.microfacets = true;
        traits.anisotropic |= roughness.anisotropic();
        traits.textured |= roughness.alpha_u.varies() || roughness.alpha_v.varies();
    }
};

}  // namespace

MaterialTraits own_traits(const Material& material) {
    MaterialTraits traits;
    traits.lobes = std::visit([](const auto& kind) { return kind.lobes(); }, material.bsdf);
    visit_fields(material.bsdf, FieldTraits(traits));
    traits.coated = std::visit(
        [](const auto& kind) {
            return requires {
                kind.kCoated;
            };
        },
        material.bsdf);
    traits.blended = std::holds_alternative<BlendMaterial>(material.bsdf);
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
    // A part has a smaller index than its whole: by taking the highest first, each is visited once, even if shared.
    std::set<std::int32_t, std::greater<>> reached = {material};
    while (!reached.empty()) {
        const std::int32_t index = *reached.begin();
        reached.erase(reached.begin());
        const Material& description = scene.materials[static_cast<std::size_t>(index)];
        MaterialTraits own = own_traits(description);
        own.masked = own.masked && index == material;
        traits |= own;
        for_each_part(description, [&](std::int32_t part) { reached.insert(part); });
    }
    return traits;
}

std::vector<bool> used_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Shape& shape : scene.shapes)
        if (shape.material != kNone) used[static_cast<std::size_t>(shape.material)] = true;
    for (std::size_t i = scene.materials.size(); i-- > 0;)
        if (used[i])
            for_each_part(scene.materials[i], [&](std::int32_t part) { used[static_cast<std::size_t>(part)] = true; });
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
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i] && !std::holds_alternative<DiffuseMaterial>(scene.materials[i].bsdf)) return false;
    return (traits.lobes == nothing_but_diffuse || traits.lobes == Lobes{}) && !traits.textured && !traits.bumped &&
           !traits.normal_mapped && !traits.own_back && !traits.blended;
}

}  // namespace treefarm
