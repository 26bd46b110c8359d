// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/approximation.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"
#include "common/scene/uses/mesh_attribute_uses.h"
#include "common/scene/uses/remove_unused.h"

namespace treefarm {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
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
        if (shape.emitter != kNone) needed = needed || is_textured(scene.emitters[at(shape.emitter)]);
        if (!needed) mesh->uvs = {};
    }
}

}  // namespace

void strip_scene(Scene& scene) {
    remove_unused(scene);
    strip_coordinates(scene);
    remove_unused_attributes(scene);
}

}  // namespace treefarm
