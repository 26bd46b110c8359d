#include "common/plan/strip_scene.h"

#include "common/plan/texture_uses.h"
#include "common/scene/material_traits.h"

namespace treefarm {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

/// Removes the entries that are not used, and says where each of the others went.
template <class T>
std::vector<std::int32_t> keep_used(std::vector<T>& entries, const std::vector<bool>& used) {
    std::vector<std::int32_t> moved(entries.size(), kNone);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!used[i]) continue;
        moved[i] = static_cast<std::int32_t>(kept);
        if (kept != i) entries[kept] = std::move(entries[i]);
        ++kept;
    }
    entries.resize(kept);
    return moved;
}

void strip_textures(Scene& scene) {
    const std::vector<bool> used_material = used_materials(scene);
    std::vector<bool> used(scene.textures.size(), false);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (used_material[i]) for_each_texture(scene.materials[i], [&](std::int32_t t) { used[at(t)] = true; });
    for (const Emitter& emitter : scene.emitters)
        if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind); area && area->radiance.varies())
            used[at(area->radiance.texture)] = true;
    const std::vector<std::int32_t> moved = keep_used(scene.textures, used);
    for (Material& material : scene.materials)  // one that no shape uses may name a texture that is gone
        for_each_texture(material, [&](std::int32_t& t) { t = moved[at(t)]; });
    for (Emitter& emitter : scene.emitters)
        if (auto* area = std::get_if<AreaEmitter>(&emitter.kind); area && area->radiance.varies())
            area->radiance.texture = moved[at(area->radiance.texture)];
}

void strip_images(Scene& scene) {
    std::vector<bool> used(scene.images.size(), false);
    const auto for_each_image = [&](auto&& f) {
        for (Texture& texture : scene.textures)
            if (auto* bitmap = std::get_if<BitmapTexture>(&texture.kind)) f(bitmap->image);
        for (Emitter& emitter : scene.emitters)
            if (auto* environment = std::get_if<EnvironmentEmitter>(&emitter.kind)) f(environment->image);
    };
    for_each_image([&](std::int32_t image) { used[at(image)] = true; });
    const std::vector<std::int32_t> moved = keep_used(scene.images, used);
    for_each_image([&](std::int32_t& image) { image = moved[at(image)]; });
}

void strip_coordinates(Scene& scene) {
    for (Shape& shape : scene.shapes) {
        auto* mesh = std::get_if<Mesh>(&shape.geometry);
        if (!mesh || mesh->uvs.empty()) continue;
        bool needed = false;
        if (shape.material != kNone) {
            const Material& material = scene.materials[at(shape.material)];
            needed = material.opacity.varies() || material_traits(scene, shape.material).needs_surface_detail();
        }
        if (shape.emitter != kNone) {
            const auto& area = std::get<AreaEmitter>(scene.emitters[at(shape.emitter)].kind);
            needed = needed || area.radiance.varies();
        }
        if (!needed) mesh->uvs = {};
    }
}

}  // namespace

void strip_scene(Scene& scene) {
    strip_textures(scene);
    strip_images(scene);
    strip_coordinates(scene);
}

}  // namespace treefarm
