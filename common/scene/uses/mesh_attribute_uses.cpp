// SPDX-License-Identifier: Apache-2.0
#include "common/scene/uses/mesh_attribute_uses.h"

#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_uses.h"

namespace treefarm {
namespace {

template <class T>
const T* at(const std::vector<T>& list, std::int32_t index) {
    return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)]
                                                                       : nullptr;
}

}  // namespace

std::string attribute_of(const Texture& texture) {
    struct : IgnoreFields {
        std::string found;
        void mesh_attribute(const std::string& name) { found = name; }
    } visitor;
    visit_fields(texture.kind, visitor);
    return visitor.found;
}

std::vector<std::set<std::int32_t>> textures_of_shapes(const Scene& scene) {
    using Textures = std::set<std::int32_t>;
    // Parts of a material have smaller indices.
    std::vector<Textures> materials(scene.materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i) {
        for_each_texture(scene.materials[i], [&](std::int32_t texture) { materials[i].insert(texture); });
        for_each_part(scene.materials[i], [&](std::int32_t part) {
            if (part >= 0 && static_cast<std::size_t>(part) < i)
                materials[i].insert(materials[static_cast<std::size_t>(part)].begin(),
                                    materials[static_cast<std::size_t>(part)].end());
        });
    }
    std::vector<Textures> shapes(scene.shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (const Textures* textures = at(materials, scene.shapes[i].material)) shapes[i] = *textures;
        if (const Emitter* emitter = at(scene.emitters, scene.shapes[i].emitter))
            for_each_texture(*emitter, [&](std::int32_t texture) { shapes[i].insert(texture); });
    }
    return shapes;
}

std::vector<std::set<std::string>> mesh_attribute_uses(const Scene& scene) {
    std::vector<std::set<std::string>> names;
    for (const std::set<std::int32_t>& textures : textures_of_shapes(scene)) {
        names.emplace_back();
        for (const std::int32_t index : textures)
            if (const Texture* texture = at(scene.textures, index))
                if (const std::string name = attribute_of(*texture); !name.empty()) names.back().insert(name);
    }
    return names;
}

void remove_unused_attributes(Scene& scene) {
    const std::vector<std::set<std::string>> uses = mesh_attribute_uses(scene);
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (auto* mesh = std::get_if<Mesh>(&scene.shapes[i].geometry))
            std::erase_if(mesh->attributes, [&](const MeshAttribute& a) { return !uses[i].contains(a.name); });
}

}  // namespace treefarm
