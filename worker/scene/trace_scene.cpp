// SPDX-License-Identifier: Apache-2.0
#include "worker/scene/trace_scene.h"

#include <cassert>

#include "common/plan/schedule/learning.h"
#include "common/scene/uses/material_traits.h"

namespace treefarm {
namespace {

/// Whether the scene's surfaces are all plainly diffuse, or no other kernels are compiled.
bool traced_plainly(const Scene& scene, const Resolved& job) {
    return is_plainly_diffuse(scene) && has_plain_kernels(guide_kind(job));
}

/// BSDF per shape of a plainly diffuse scene; a shape without material is black.
std::vector<PlainDiffuse> diffuse_bsdfs(const Scene& scene) {
    std::vector<PlainDiffuse> bsdfs(scene.shapes.size());
    for (std::size_t i = 0; i < bsdfs.size(); ++i) {
        const std::int32_t material = scene.shapes[i].material;
        if (material == kNone) continue;
        const Material& m = scene.materials[static_cast<std::size_t>(material)];
        bsdfs[i] = {std::get<DiffuseMaterial>(m.bsdf).reflectance.value, m.twosided};
    }
    return bsdfs;
}

/// Opacity per shape; empty if no shape has a mask.
std::vector<FloatInput> shape_opacity(const Scene& scene) {
    std::vector<FloatInput> opacity;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const std::int32_t material = scene.shapes[i].material;
        if (material == kNone || !scene.materials[static_cast<std::size_t>(material)].masked()) continue;
        if (opacity.empty()) opacity.resize(scene.shapes.size(), FloatInput(1.0f));
        opacity[i] = scene.materials[static_cast<std::size_t>(material)].opacity;
    }
    return opacity;
}

/// Shapes that camera rays pass since they are hidden emitters; empty if there are none.
std::vector<bool> hidden_shapes(const Scene& scene, const Resolved& job) {
    std::vector<bool> hidden;
    if (!job.integrator.hide_emitters || !scene.camera.passes_hidden_emitters) return hidden;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        if (scene.shapes[i].emitter == kNone) continue;
        hidden.resize(scene.shapes.size());
        hidden[i] = true;
    }
    return hidden;
}

std::optional<MaterialSet> make_materials(const Scene& scene, const Resolved& job, const TextureSet& textures) {
    if (traced_plainly(scene, job)) return std::nullopt;
    return std::optional<MaterialSet>(std::in_place, scene, textures);
}

}  // namespace

TraceScene::TraceScene(Scene scene, const Resolved& job)
    : TraceScene(std::move(scene), {shape_opacity(scene), hidden_shapes(scene, job)}, job) {}

TraceScene::TraceScene(Scene&& scene, ShapeMasks masks, const Resolved& job)
    : effects_(find_scene_effects(scene, job)),
      film_(scene.film),
      camera_(scene.camera, scene.film),
      bounds_(scene.bounds()),
      textures_(std::move(scene.textures), std::move(scene.images)),
      plain_diffuse_(traced_plainly(scene, job) ? diffuse_bsdfs(scene) : std::vector<PlainDiffuse>()),
      materials_(make_materials(scene, job, textures_)),
      geometry_(textures_.arranged(std::move(scene.shapes)), job.farm.isa,
                {std::move(masks.opacity), std::move(masks.hidden), &textures_}, job.farm.robust),
      emitters_(scene.emitters, geometry_, bounds_, &textures_, job.integrator.light_selection) {
    assert(effects_.lens == camera_.has_lens());
    assert(effects_.masks == geometry_.masked());
    assert(effects_.environment || !emitters_.shines_from_infinity());
}

}  // namespace treefarm
